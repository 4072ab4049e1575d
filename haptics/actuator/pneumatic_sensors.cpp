// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/pneumatic_sensors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "artus/detail/core/noise.h"

namespace artus {

double ProbeSensors::sense(ProbeSensor sensor, const SensorParams& params, double value) noexcept {
  const auto i = static_cast<std::size_t>(sensor);
  const double span = params.high - params.low;
  switch (faults_[i]) {
    case SensorFault::not_a_number:
      return std::numeric_limits<double>::quiet_NaN();
    case SensorFault::stuck:
      return last_[i];
    case SensorFault::lost:
      return params.low - 0.1 * span;
    case SensorFault::none:
      break;
  }
  double reading = value;
  if (params.noise > 0) reading += params.noise * normal_noise(seed_ + i, count_);
  if (params.step > 0) reading = params.step * std::round(reading / params.step);
  last_[i] = std::clamp(reading, params.low, params.high);
  return last_[i];
}

ProbeMeasurement ProbeSensors::read(const PneumaticPlant& plant) noexcept {
  const CylinderState& s = plant.state();
  ProbeMeasurement m;
  m.y = sense(ProbeSensor::position, params_.position, s.y);
  m.p_P = sense(ProbeSensor::pressure_p, params_.pressure, s.p_P);
  m.p_N = sense(ProbeSensor::pressure_n, params_.pressure, s.p_N);
  m.force = sense(ProbeSensor::force, params_.force, plant.contact_force());
  ++count_;
  return m;
}

}  // namespace artus
