// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/control_law_supervisor.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/haptics/actuator/pneumatic_cylinder.h"

namespace artus {
namespace {

/// Low-pass of the force estimate, Hz; assumed: slower than the velocity's, faster than a hand.
constexpr double kEstimateFilter = 10;
/// An offset below this is no blending any more, V.
constexpr double kBlended = 1e-3;

bool is_finite(const ProbeTarget& t) noexcept {
  return std::isfinite(t.y) && std::isfinite(t.v) && std::isfinite(t.a) && std::isfinite(t.j) &&
         std::isfinite(t.stiffness) && t.stiffness > 0 && std::isfinite(t.damping) &&
         std::isfinite(t.pneumatic) && std::isfinite(t.pneumatic_rate) &&
         std::isfinite(t.inclination) && std::isfinite(t.known_force);
}

}  // namespace

ControlSupervisor::ControlSupervisor(const ControlParams& control, const PneumaticParams& plant,
                                     const SupervisorParams& supervisor, ControlLawKind kind)
    : control_(control),
      plant_(plant),
      params_(supervisor),
      dt_(1 / control.rate),
      map_(plant.valve, plant.cylinder),
      kind_(kind),
      velocity_(control.velocity_filter, dt_),
      force_(kEstimateFilter, dt_),
      healthy_(supervisor.retry_after) {
  for (std::size_t i = 0; i < kControlLaws; ++i) {
    laws_[i] = make_control_law(static_cast<ControlLawKind>(i), control_, plant_, map_);
  }
  stand_still();
}

void ControlSupervisor::select(ControlLawKind kind) noexcept {
  if (kind == kind_) return;
  kind_ = kind;
  restart_ = true;
}

void ControlSupervisor::stand_still() noexcept {
  tick_.command = {plant_.valve.centre_voltage, plant_.valve.centre_voltage};
  engaged_ = false;
  restart_ = true;
}

std::uint32_t ControlSupervisor::find_sensor_faults(const ProbeMeasurement& m) noexcept {
  const std::array<double, kProbeSensors> readings{m.y, m.p_P, m.p_N, m.force};
  const std::array<const SensorParams*, kProbeSensors> sensors{
      &plant_.sensors.position, &plant_.sensors.pressure, &plant_.sensors.pressure,
      &plant_.sensors.force};
  std::uint32_t faults = 0;
  const std::size_t used = needs_force_sensor(kind_) ? kProbeSensors : kProbeSensors - 1;
  for (std::size_t i = 0; i < kProbeSensors; ++i) {
    const bool same = readings[i] == last_reading_[i];
    unchanged_[i] = same ? unchanged_[i] + dt_ : 0;
    last_reading_[i] = readings[i];
    if (i >= used) continue;
    if (!std::isfinite(readings[i])) {
      faults |= ControlStatus::kNotFinite;
    } else if (readings[i] < sensors[i]->low || readings[i] > sensors[i]->high) {
      faults |= ControlStatus::kSensorLost;
    } else if (params_.stuck_after > 0 && unchanged_[i] >= params_.stuck_after) {
      faults |= ControlStatus::kSensorStuck;
    }
  }
  return faults;
}

std::uint32_t ControlSupervisor::find_plant_faults(const ProbeMeasurement& m) noexcept {
  const bool low = (m.p_P + m.p_N) / 2 < params_.supply_share * plant_.valve.supply;
  low_supply_ = low ? low_supply_ + dt_ : 0;
  const double span = plant_.valve.voltage_span;
  const bool saturated = std::abs(tick_.command.u_P - plant_.valve.centre_voltage) >= span ||
                         std::abs(tick_.command.u_N - plant_.valve.centre_voltage) >= span;
  const bool at_stop = std::abs(m.y) > plant_.cylinder.travel - params_.stop_margin;
  overloaded_ = engaged_ && (saturated || at_stop) ? overloaded_ + dt_ : 0;
  std::uint32_t faults = 0;
  if (low_supply_ >= params_.supply_after) faults |= ControlStatus::kSupplyLost;
  if (overloaded_ >= params_.overload_after) faults |= ControlStatus::kOverload;
  return faults;
}

void ControlSupervisor::estimate(const ProbeMeasurement& m) noexcept {
  const double y = m.y;
  if (!have_y_) velocity_.reset(0);
  tick_.v = velocity_.step(have_y_ ? (y - last_y_) / dt_ : 0);
  last_y_ = y;
  CylinderState s;
  s.y = y;
  s.p_P = m.p_P;
  s.p_N = m.p_N;
  const CylinderParams& c = plant_.cylinder;
  const double weight = c.moving_mass * kGravity * std::cos(target_.inclination);
  const double force = pneumatic_force(c, s) - c.viscous_friction * tick_.v - weight;
  if (!have_y_) force_.reset(force);
  tick_.estimated_force = force_.step(force);
  have_y_ = true;
}

void ControlSupervisor::run_law(const ProbeMeasurement& m) noexcept {
  ControlInput input;
  input.measured = m;
  input.v = tick_.v;
  input.target = target_;
  ControlLaw& law = *laws_[static_cast<std::size_t>(kind_)];
  if (restart_) law.reset(input);
  const ControlOutput out = law.step(input);
  if (restart_) {
    offset_P_ = tick_.command.u_P - out.command.u_P;
    offset_N_ = tick_.command.u_N - out.command.u_N;
    restart_ = false;
  } else {
    const double fade = std::exp(-dt_ / params_.blend_time);
    offset_P_ *= fade;
    offset_N_ *= fade;
  }
  const double top = plant_.valve.centre_voltage + plant_.valve.voltage_span;
  const double bottom = plant_.valve.centre_voltage - plant_.valve.voltage_span;
  tick_.command.u_P = std::clamp(out.command.u_P + offset_P_, bottom, top);
  tick_.command.u_N = std::clamp(out.command.u_N + offset_N_, bottom, top);
  tick_.reference = out.reference;
  if (out.target_refused) tick_.status |= ControlStatus::kTargetRefused;
  if (std::max(std::abs(offset_P_), std::abs(offset_N_)) > kBlended) {
    tick_.status |= ControlStatus::kBlending;
  }
}

const ControlTick& ControlSupervisor::step(const ProbeMeasurement& measured,
                                           const ProbeTarget& target) noexcept {
  tick_.status = 0;
  if (is_finite(target)) {
    target_ = target;
  } else {
    tick_.status |= ControlStatus::kTargetRefused;
  }
  const std::uint32_t sensor_faults = find_sensor_faults(measured);
  if (sensor_faults == 0) {
    estimate(measured);
    tick_.status |= find_plant_faults(measured);
  } else {
    tick_.status |= sensor_faults;
    have_y_ = false;
  }
  if ((tick_.status & ControlStatus::kFaults) != 0) {
    stand_still();
    healthy_ = 0;
    return tick_;
  }
  healthy_ += dt_;
  if (!engaged_ && healthy_ < params_.retry_after) {
    tick_.status |= ControlStatus::kWaiting;
    return tick_;
  }
  engaged_ = true;
  run_law(measured);
  return tick_;
}

}  // namespace artus
