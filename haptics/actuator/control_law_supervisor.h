// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "artus/detail/haptics/actuator/admittance_filter.h"
#include "artus/detail/haptics/actuator/control_law.h"

namespace artus {

/// What is wrong with the actuator, or remarkable, in a tick; a bit field.
struct ControlStatus {
  static constexpr std::uint32_t kOk = 0;
  static constexpr std::uint32_t kNotFinite = 1U << 0U;    ///< a needed sensor reads NaN
  static constexpr std::uint32_t kSensorLost = 1U << 1U;   ///< a needed sensor is out of its range
  static constexpr std::uint32_t kSensorStuck = 1U << 2U;  ///< a needed sensor never changes
  static constexpr std::uint32_t kSupplyLost = 1U << 3U;   ///< both chambers ran empty
  static constexpr std::uint32_t kOverload = 1U << 4U;  ///< rod held at a stop or valve saturated
  static constexpr std::uint32_t kWaiting = 1U << 5U;   ///< healthy again, not yet engaged
  static constexpr std::uint32_t kBlending = 1U << 6U;  ///< the command still approaches the law's
  static constexpr std::uint32_t kTargetRefused = 1U << 7U;  ///< the last valid target stays
  /// Those that put the valves to the centre.
  static constexpr std::uint32_t kFaults = (1U << 6U) - 1;
};

/// When the supervisor calls something a fault; all assumed, for a control tick of 1 kHz or more.
struct SupervisorParams {
  double stuck_after = 0.05;     ///< s of the same reading; 0: never (a simulation without noise)
  double supply_share = 0.5;     ///< of the supply, mean chamber pressure below which it is lost;
                                 ///< a working valve keeps the mean above 0.6
  double supply_after = 0.02;    ///< s below it
  double overload_after = 0.25;  ///< s at a stop or saturated
  double stop_margin = 0.1e-3;   ///< m from a stop that counts as at it
  double retry_after = 0.5;      ///< s of health before the law is engaged again
  double blend_time = 0.1;       ///< s, time constant from the old command to the law's
};

/// One tick of the supervised actuator.
struct ControlTick {
  ValveCommand command;        ///< 0..10 V; the centre on any fault
  std::uint32_t status = 0;    ///< ControlStatus bits
  double reference = 0;        ///< m, see ControlOutput
  double v = 0;                ///< m/s, estimated
  double estimated_force = 0;  ///< N, on the rod, from the pressures alone; within dry friction
};

/// Runs one of all control laws, chosen at any time, on measurements that may be wrong. The command
/// never jumps except to the centre on a fault: after a change of law or a recovery it starts where
/// it was and approaches the law's exponentially, which leaves the law's feedback at full gain.
class ControlSupervisor {
 public:
  /// Requires: a positive rate (std::invalid_argument).
  ControlSupervisor(const ControlParams& control, const PneumaticParams& plant,
                    const SupervisorParams& supervisor, ControlLawKind kind);

  /// Exchanges the law; takes effect at the next step.
  ARTUS_REALTIME void select(ControlLawKind kind) noexcept;
  [[nodiscard]] ControlLawKind selected() const noexcept { return kind_; }

  /// One control period. Errors: none; any input gives voltages within 0..10 V.
  ARTUS_REALTIME const ControlTick& step(const ProbeMeasurement& measured,
                                         const ProbeTarget& target) noexcept;

  [[nodiscard]] double period() const noexcept { return dt_; }  ///< s

 private:
  [[nodiscard]] std::uint32_t find_sensor_faults(const ProbeMeasurement& m) noexcept;
  [[nodiscard]] std::uint32_t find_plant_faults(const ProbeMeasurement& m) noexcept;
  void estimate(const ProbeMeasurement& m) noexcept;
  void run_law(const ProbeMeasurement& m) noexcept;
  void stand_still() noexcept;

  ControlParams control_;
  PneumaticParams plant_;
  SupervisorParams params_;
  double dt_;
  ValveMap map_;
  std::array<std::unique_ptr<ControlLaw>, kControlLaws> laws_;
  ControlLawKind kind_;

  ProbeTarget target_;
  ControlTick tick_;
  LowPass velocity_;
  LowPass force_;
  std::array<double, kProbeSensors> last_reading_{};
  std::array<double, kProbeSensors> unchanged_{};  // s
  double last_y_ = 0;
  bool have_y_ = false;
  bool engaged_ = false;
  bool restart_ = true;
  double healthy_ = 0;     // s; the first engagement need not wait
  double low_supply_ = 0;  // s
  double overloaded_ = 0;  // s
  double offset_P_ = 0;    // V
  double offset_N_ = 0;    // V
};

}  // namespace artus
