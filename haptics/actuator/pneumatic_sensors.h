// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>

#include "artus/detail/haptics/actuator/pneumatic_plant.h"

namespace artus {

/// One reading of all sensors of the mock, as the controller gets it.
struct ProbeMeasurement {
  double y = 0;      ///< m, rod position from mid-stroke
  double p_P = 0;    ///< Pa absolute
  double p_N = 0;    ///< Pa absolute
  double force = 0;  ///< N on the rod's head, positive pushes it in
};

/// The sensors by name.
enum class ProbeSensor : std::uint8_t { position, pressure_p, pressure_n, force };
inline constexpr std::size_t kProbeSensors = 4;

/// What a broken sensor reports.
enum class SensorFault : std::uint8_t {
  none,
  not_a_number,
  stuck,  ///< its last value for ever
  lost    ///< below its range, like a broken wire
};

/// Reads the plant through noise and quantisation. The noise is a pure function of the seed and the
/// count of readings.
class ProbeSensors {
 public:
  ProbeSensors(const ProbeSensorParams& params, std::uint64_t seed) noexcept
      : params_(params), seed_(seed) {}

  /// The next reading.
  [[nodiscard]] ARTUS_REALTIME ProbeMeasurement read(const PneumaticPlant& plant) noexcept;

  /// Breaks a sensor, or mends it (SensorFault::none).
  void set_fault(ProbeSensor sensor, SensorFault fault) noexcept {
    faults_[static_cast<std::size_t>(sensor)] = fault;
  }

 private:
  [[nodiscard]] double sense(ProbeSensor sensor, const SensorParams& params, double value) noexcept;

  ProbeSensorParams params_;
  std::uint64_t seed_;
  std::uint64_t count_ = 0;
  std::array<SensorFault, kProbeSensors> faults_{};
  std::array<double, kProbeSensors> last_{};
};

}  // namespace artus
