// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/probe/probe_experiment_bench.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/core/csv.h"

namespace artus {
namespace {

constexpr double kRowPeriod = 2e-3;  // s
constexpr double kLayingTime = 0.3;  // s

ProbeRow make_row(double time, const PneumaticPlant& plant, const ProbeTarget& target,
                  const ControlTick& tick) {
  const CylinderState& s = plant.state();
  ProbeRow row;
  row.time = time;
  row.stiffness = target.stiffness;
  row.rest = target.y;
  row.force = plant.contact_force();
  row.expected = target.y - row.force / target.stiffness;
  row.y = s.y;
  row.v = s.v;
  row.u_P = tick.command.u_P;
  row.u_N = tick.command.u_N;
  row.p_P = s.p_P;
  row.p_N = s.p_N;
  row.pneumatic = pneumatic_stiffness(plant.cylinder(), s);
  row.status = tick.status;
  const RodEnergy& e = plant.energy();
  row.energy_error =
      plant.kinetic_energy() - (e.gas + e.external + e.weight + e.friction + e.stops);
  return row;
}

}  // namespace

std::vector<ProbeRow> run_probe_scenario(const ProbeScenario& scenario) {
  ARTUS_REQUIRE(static_cast<bool>(scenario.target), "a scenario needs a target");
  PneumaticParams params = scenario.plant;
  for (SensorParams* s :
       {&params.sensors.pressure, &params.sensors.position, &params.sensors.force}) {
    s->noise *= scenario.noise;
  }
  PneumaticPlant plant(params, ValveLayout::two);
  ProbeSensors sensors(params.sensors, scenario.seed);
  ControlSupervisor supervisor(scenario.control, params, {}, scenario.law);
  const double dt = supervisor.period();
  const auto ticks = std::lround(scenario.duration / dt);
  const auto stride = std::max(1L, std::lround(kRowPeriod / dt));
  std::vector<ProbeRow> rows;
  rows.reserve(static_cast<std::size_t>(ticks / stride + 1));
  for (long i = 0; i < ticks; ++i) {
    const double t = static_cast<double>(i) * dt;
    if (scenario.disturb) scenario.disturb(t, plant, sensors);
    ProbeTarget target = scenario.target(t);
    const ProbeMeasurement measured = sensors.read(plant);
    if (scenario.stiffness) target.stiffness = scenario.stiffness(measured.y);
    const ControlTick& tick = supervisor.step(measured, target);
    const RodLoad load = scenario.load ? scenario.load(t, plant.state()) : RodLoad{};
    plant.step(tick.command, load, dt);
    if (i % stride == 0) rows.push_back(make_row(t, plant, target, tick));
  }
  return rows;
}

std::function<ProbeTarget(double)> ramp_stiffness(double low, double high, double start,
                                                  double end) {
  return [=](double t) {
    ProbeTarget target;
    const double share = std::clamp((t - start) / (end - start), 0.0, 1.0);
    target.stiffness = low + share * (high - low);
    return target;
  };
}

std::function<ProbeTarget(double)> step_stiffness(std::vector<double> values, double start,
                                                  double plateau) {
  ARTUS_REQUIRE(!values.empty() && plateau > 0, "steps need values and a length");
  return [values = std::move(values), start, plateau](double t) {
    const double place = std::max(0.0, (t - start) / plateau);
    const auto i = std::min(static_cast<std::size_t>(place), values.size() - 1);
    ProbeTarget target;
    target.stiffness = values[i];
    return target;
  };
}

std::function<RodLoad(double, const CylinderState&)> lay_mass(double mass, double time) {
  return [=](double t, const CylinderState&) {
    RodLoad load;
    if (t < time) return load;
    load.mass = mass;
    load.force = -mass * kGravity * std::max(0.0, 1 - (t - time) / kLayingTime);
    return load;
  };
}

ProbeWindow measure_window(const std::vector<ProbeRow>& rows, double from, double to) {
  ProbeWindow w;
  std::size_t n = 0;
  double last = 0;
  for (const ProbeRow& row : rows) {
    if (row.time < from || row.time >= to) continue;
    const double error = std::abs(row.error());
    if (n == 0) {
      w.lowest_voltage = w.highest_voltage = last = row.u_P;
      w.lowest_pneumatic = w.highest_pneumatic = row.pneumatic;
      w.lowest_pressure = w.highest_pressure = row.p_P;
    }
    w.largest_error = std::max(w.largest_error, error);
    w.mean_error += error;
    w.lowest_voltage = std::min(w.lowest_voltage, row.u_P);
    w.highest_voltage = std::max(w.highest_voltage, row.u_P);
    w.voltage_travel += std::abs(row.u_P - last);
    w.lowest_pneumatic = std::min(w.lowest_pneumatic, row.pneumatic);
    w.highest_pneumatic = std::max(w.highest_pneumatic, row.pneumatic);
    w.lowest_pressure = std::min({w.lowest_pressure, row.p_P, row.p_N});
    w.highest_pressure = std::max({w.highest_pressure, row.p_P, row.p_N});
    w.energy_error = std::max(w.energy_error, std::abs(row.energy_error));
    last = row.u_P;
    ++n;
  }
  if (n > 0) w.mean_error /= static_cast<double>(n);
  if (to > from) w.voltage_travel /= to - from;
  return w;
}

std::string probe_csv(const std::vector<ProbeRow>& rows) {
  std::string text =
      "time_s,stiffness_n_m,rest_m,expected_m,position_m,velocity_m_s,force_n,voltage_p_v,"
      "voltage_n_v,pressure_p_pa,pressure_n_pa,pneumatic_stiffness_n_m,energy_error_j,status\n";
  for (const ProbeRow& r : rows) {
    for (const double value : {r.time, r.stiffness, r.rest, r.expected, r.y, r.v, r.force, r.u_P,
                               r.u_N, r.p_P, r.p_N, r.pneumatic, r.energy_error}) {
      text += to_csv(value) + ',';
    }
    text += std::to_string(r.status) + '\n';
  }
  return text;
}

}  // namespace artus
