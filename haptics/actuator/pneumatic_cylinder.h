// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/check.h"
#include "artus/detail/haptics/actuator/pneumatic_params.h"

namespace artus {

/// Position (m, from mid-stroke, chamber P grows with it), speed (m/s) and absolute chamber
/// pressures (Pa).
struct CylinderState {
  double y = 0;
  double v = 0;
  double p_P = 1e5;
  double p_N = 1e5;
};

/// Mass flows into the chambers, kg/s.
struct ChamberFlows {
  double q_P = 0;
  double q_N = 0;
};

/// The same flows seen as what moves the rod and what stiffens it, kg/s.
struct ActiveFlows {
  double q_A = 0;  ///< active
  double q_T = 0;  ///< pressurisation
};

/// Pressure rates of the two chambers, Pa/s.
struct PressureRates {
  double dp_P = 0;
  double dp_N = 0;
};

/// F = S_P p_P - S_N p_N, N. Source [Alamilla2020] (3.2).
[[nodiscard]] ARTUS_REALTIME double pneumatic_force(const CylinderParams& c,
                                                    const CylinderState& s) noexcept;

/// K_pneu, N/m: how the force falls with y when no air flows. Source [Alamilla2020] (3.16).
[[nodiscard]] ARTUS_REALTIME double pneumatic_stiffness(const CylinderParams& c,
                                                        const CylinderState& s) noexcept;

/// Polytropic chambers. Source [Alamilla2020] (3.4) with "+" in chamber N, which shrinks as y
/// grows.
[[nodiscard]] ARTUS_REALTIME PressureRates pressure_rates(const CylinderParams& c,
                                                          const CylinderState& s,
                                                          const ChamberFlows& q) noexcept;

/// The A-T transform and its inverse. Source [Alamilla2020] (3.13), (3.14), (3.35).
[[nodiscard]] ARTUS_REALTIME ActiveFlows to_active(const CylinderParams& c, double y,
                                                   const ChamberFlows& q) noexcept;
[[nodiscard]] ARTUS_REALTIME ChamberFlows to_chambers(const CylinderParams& c, double y,
                                                      const ActiveFlows& q) noexcept;

/// dF/dt, N/s. Source [Alamilla2020] (3.17).
[[nodiscard]] ARTUS_REALTIME double force_rate(const CylinderParams& c, const CylinderState& s,
                                               const ActiveFlows& q) noexcept;

/// dK_pneu/dt, N/(m s). Source [Alamilla2020] (3.17) with "- B1", as (3.33) has it.
[[nodiscard]] ARTUS_REALTIME double stiffness_rate(const CylinderParams& c, const CylinderState& s,
                                                   const ActiveFlows& q) noexcept;

/// The smallest K_pneu the cylinder can have with both chambers at `p` or more, N/m.
/// Source [Alamilla2020] (3.43).
[[nodiscard]] double min_pneumatic_stiffness(const CylinderParams& c, double p) noexcept;

/// K_pneu with both chambers at `p` and the rod at `y`, N/m: (3.43)'s K_max at the end stop.
[[nodiscard]] double max_pneumatic_stiffness(const CylinderParams& c, double p, double y) noexcept;

}  // namespace artus
