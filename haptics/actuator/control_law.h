// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/core/check.h"
#include "artus/detail/haptics/actuator/pneumatic_sensors.h"
#include "artus/detail/haptics/actuator/valve_map.h"

namespace artus {

/// What the actuator is asked to render: a spring about a reference.
struct ProbeTarget {
  double y = 0;               ///< m, x_0, where the rod is when nobody pushes
  double v = 0;               ///< m/s
  double a = 0;               ///< m/s^2
  double j = 0;               ///< m/s^3
  double stiffness = 800;     ///< N/m, K_c of the admittance laws, K_cl of backstepping
  double damping = 0;         ///< N s/m, B_cl of backstepping; 0: just above critical
  double pneumatic = 2500;    ///< N/m, wanted K_pneu (two valves)
  double pneumatic_rate = 0;  ///< N/(m s), its rate
  double inclination = 0;     ///< rad, theta
  double known_force = 0;     ///< N, part of F_ext that must not move the rod; see backstepping
};

/// What a law sees in one tick.
struct ControlInput {
  ProbeMeasurement measured;
  double v = 0;  ///< m/s, filtered derivative of the measured position
  ProbeTarget target;
};

/// A law's answer.
struct ControlOutput {
  ValveCommand command;
  double reference = 0;  ///< m, where the law drives the rod: x_c of the admittance laws, else x_0
  bool target_refused = false;  ///< gains not valid for this stiffness: the last valid ones stay
};

enum class ControlLawKind : std::uint8_t {
  pid,
  admittance_pid,
  ipc,
  admittance_ipc,
  backstepping_one_valve,
  backstepping_two_valves
};
inline constexpr std::size_t kControlLaws = 6;

/// The name that files and flags use.
[[nodiscard]] const char* to_string(ControlLawKind kind) noexcept;
/// Errors: not_found, with the names there are.
[[nodiscard]] Result<ControlLawKind> find_control_law(std::string_view name);
/// Whether the law reads the force sensor.
[[nodiscard]] bool needs_force_sensor(ControlLawKind kind) noexcept;

/// Gains of the PID laws. Source [Alamilla2020] table 3.2.
struct PidGains {
  double proportional = 60;   ///< V/m
  double integral = 5;        ///< V/(m s)
  double derivative = 20;     ///< V s/m
  double integral_limit = 1;  ///< V, anti-windup; assumed
};

/// Gains of the IPC laws. Source [Alamilla2020] table 3.2; the damping is not printed: critical for
/// the virtual mass on both springs.
struct IpcGains {
  double k_1 = 55;    ///< N/m, reference to virtual mass
  double k_2 = 100;   ///< N/m and V/m, virtual mass to rod
  double mass = 0.4;  ///< kg, M_v
  [[nodiscard]] double damping() const noexcept;
};

/// Gains of backstepping. Source [Alamilla2020] table 3.3; K_3i is not printed.
struct BacksteppingGains {
  double c_1 = 780;         ///< 1/s
  double c_2 = 280;         ///< 1/s
  double c_3 = 2100;        ///< 1/s
  double c_4 = 100;         ///< 1/s, of K_pneu
  double k_3i = 2e4;        ///< 1/s^2, of the integral of z_3; assumed: 0.1 s on top of C_3
  double z_3i_limit = 1;    ///< N s, anti-windup; assumed
  bool from_target = true;  ///< C_1 and C_2 from the target's stiffness and damping instead
};

/// Everything a law is built from.
struct ControlParams {
  PidGains pid;
  IpcGains ipc;
  BacksteppingGains backstepping;
  double force_filter = 2;  ///< Hz, low-pass of the force sensor in the admittance; assumed: the
                            ///< printed K_d with a 1 kg mass on the sensor chatters from 5 Hz
  double velocity_filter = 150;  ///< Hz, low-pass of the position's derivative; assumed
  double rate = 5000;            ///< Hz of the control tick; assumed: C_3 = 2100 1/s needs > 2 kHz
};

/// One control law. All share this interface, so they can be compared and exchanged at run time.
class ControlLaw {
 public:
  ControlLaw() = default;
  ControlLaw(const ControlLaw&) = delete;
  ControlLaw& operator=(const ControlLaw&) = delete;
  virtual ~ControlLaw() = default;

  /// Forgets the past and starts from this input at rest.
  ARTUS_REALTIME virtual void reset(const ControlInput& input) noexcept = 0;

  /// One tick; the period is fixed when the law is made.
  ARTUS_REALTIME virtual ControlOutput step(const ControlInput& input) noexcept = 0;
};

/// Makes a law. The map belongs to the caller's valve and must outlive the law.
/// Requires: a positive rate (std::invalid_argument).
[[nodiscard]] std::unique_ptr<ControlLaw> make_control_law(ControlLawKind kind,
                                                           const ControlParams& control,
                                                           const PneumaticParams& plant,
                                                           const ValveMap& map);

}  // namespace artus
