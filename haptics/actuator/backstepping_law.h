// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/detail/haptics/actuator/control_law.h"
#include "artus/detail/haptics/actuator/pneumatic_cylinder.h"

namespace artus {

/// C_1 and C_2 that give a closed-loop stiffness and damping.
struct StiffnessGains {
  double c_1 = 0;  ///< 1/s, the larger
  double c_2 = 0;  ///< 1/s
};

/// The law refuses targets below this, N/m: at 50 N/m a slow push measures 11 % more, since the
/// whole stroke then gives less force than dry friction; from here on within 5 %.
inline constexpr double kMinFeltStiffness = 100;

/// The smallest closed-loop damping for a stiffness, N s/m; 0 when K_cl <= M.
/// Source [Alamilla2020] (3.41).
[[nodiscard]] double min_closed_loop_damping(double mass, double stiffness) noexcept;

/// C_1,2 = (B_cl +- sqrt(B_cl^2 - 4 M (K_cl - M))) / (2 M); empty unless K_cl > M and B_cl is at
/// least the smallest. Source [Alamilla2020] (3.40), (3.41).
[[nodiscard]] ARTUS_REALTIME std::optional<StiffnessGains> find_stiffness_gains(
    double mass, double stiffness, double damping) noexcept;

/// K_cl = M (C_1 C_2 + 1), N/m. Source [Alamilla2020] (3.37).
[[nodiscard]] double closed_loop_stiffness(double mass, double c_1, double c_2) noexcept;

/// The errors of the backstepping recursion.
struct BacksteppingErrors {
  double z_1 = 0;   ///< m
  double z_2 = 0;   ///< m/s
  double z_3 = 0;   ///< N
  double z_3i = 0;  ///< N s
  /// (z_1^2 + z_2^2 + z_3^2 + K_3i z_3i^2) / 2, which never rises when the model is exact.
  [[nodiscard]] double lyapunov(double k_3i) const noexcept {
    return (z_1 * z_1 + z_2 * z_2 + z_3 * z_3 + k_3i * z_3i * z_3i) / 2;
  }
};

/// Backstepping in position and closed-loop stiffness with one valve (the flow map's inverse gives
/// the voltage) or, with two, also in K_pneu as far as the pressures allow. An unknown push is not
/// compensated: it is what the closed-loop stiffness answers to; a known one
/// (ProbeTarget::known_force) is. Dry friction is compensated along the wanted speed only, so a rod
/// at rest is not chased across its friction. Source [Alamilla2020] (3.20)-(3.35), as corrected in
/// docs/probe.md.
class BacksteppingLaw final : public ControlLaw {
 public:
  /// Requires: the map outlives the law.
  BacksteppingLaw(const ControlParams& control, const PneumaticParams& plant, const ValveMap& map,
                  bool two_valves) noexcept;
  ARTUS_REALTIME void reset(const ControlInput& input) noexcept override;
  ARTUS_REALTIME ControlOutput step(const ControlInput& input) noexcept override;

  /// The active flow (3.31) for a state of the rod; what step() asks the valve for.
  [[nodiscard]] ARTUS_REALTIME double active_flow(const CylinderState& s,
                                                  const ProbeTarget& target) noexcept;
  [[nodiscard]] const BacksteppingErrors& errors() const noexcept { return z_; }
  [[nodiscard]] const BacksteppingGains& gains() const noexcept { return gains_; }

 private:
  bool take_gains(const ProbeTarget& target) noexcept;
  [[nodiscard]] double pressurisation_flow(const CylinderState& s, const ProbeTarget& target,
                                           double q_A) const noexcept;
  /// The K_pneu nearest to `wanted` that chambers between exhaust and supply can have at the
  /// present position and force, N/m.
  [[nodiscard]] double feasible_stiffness(const CylinderState& s, double wanted) const noexcept;
  [[nodiscard]] double dry_friction(double v_d) const noexcept;

  BacksteppingGains gains_;
  CylinderParams cylinder_;
  ServovalveParams valve_;
  const ValveMap* map_;
  bool two_valves_;
  double dt_;
  BacksteppingErrors z_;
};

}  // namespace artus
