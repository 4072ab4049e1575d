// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/haptics/actuator/control_law_supervisor.h"
#include "artus/detail/haptics/actuator/pneumatic_plant.h"

namespace artus {

// The named members of the pneumatic probe's parameters, for visit_fields (core/fields.h).

template <Like<CylinderParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [mass, area_P, area_N, dry, viscous, stroke, travel, polytropic, gas, temperature] = params;
  visit("moving_mass", mass);
  visit("area_P", area_P);
  visit("area_N", area_N);
  visit("dry_friction", dry);
  visit("viscous_friction", viscous);
  visit("stroke", stroke);
  visit("travel", travel);
  visit("polytropic", polytropic);
  visit("gas_constant", gas);
  visit("temperature", temperature);
}

template <Like<ServovalveParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [conductance, critical, laminar, centre, spool, voltage, span, supply, exhaust] = params;
  visit("sonic_conductance", conductance);
  visit("critical_ratio", critical);
  visit("laminar_ratio", laminar);
  visit("centre_opening", centre);
  visit("spool_frequency", spool);
  visit("centre_voltage", voltage);
  visit("voltage_span", span);
  visit("supply", supply);
  visit("exhaust", exhaust);
}

template <Like<SensorParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [noise, step, low, high] = params;
  visit("noise", noise);
  visit("step", step);
  visit("low", low);
  visit("high", high);
}

template <Like<ProbeSensorParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [pressure, position, force] = params;
  visit("pressure", pressure);
  visit("position", position);
  visit("force", force);
}

template <Like<PneumaticParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [cylinder, valve, sensors] = params;
  visit("cylinder", cylinder);
  visit("valve", valve);
  visit("sensors", sensors);
}

template <Like<PidGains> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [proportional, integral, derivative, limit] = params;
  visit("proportional", proportional);
  visit("integral", integral);
  visit("derivative", derivative);
  visit("integral_limit", limit);
}

template <Like<IpcGains> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [k_1, k_2, mass] = params;
  visit("k_1", k_1);
  visit("k_2", k_2);
  visit("mass", mass);
}

template <Like<BacksteppingGains> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [c_1, c_2, c_3, c_4, k_3i, limit, from_target] = params;
  visit("c_1", c_1);
  visit("c_2", c_2);
  visit("c_3", c_3);
  visit("c_4", c_4);
  visit("k_3i", k_3i);
  visit("z_3i_limit", limit);
  visit("from_target", from_target);
}

template <Like<ControlParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [pid, ipc, backstepping, force_filter, velocity_filter, rate] = params;
  visit("pid", pid);
  visit("ipc", ipc);
  visit("backstepping", backstepping);
  visit("force_filter", force_filter);
  visit("velocity_filter", velocity_filter);
  visit("rate", rate);
}

template <Like<SupervisorParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [stuck, supply_share, supply_after, overload, margin, retry, blend] = params;
  visit("stuck_after", stuck);
  visit("supply_share", supply_share);
  visit("supply_after", supply_after);
  visit("overload_after", overload);
  visit("stop_margin", margin);
  visit("retry_after", retry);
  visit("blend_time", blend);
}

namespace test {

/// Everything that a run of the pneumatic probe depends on.
struct ActuatorSetup {
  PneumaticParams plant;
  ControlParams control;
  SupervisorParams supervisor;
};
template <Like<ActuatorSetup> P, class F>
void fields_of(P& setup, F&& visit) {
  auto& [plant, control, supervisor] = setup;
  visit("plant", plant);
  visit("control", control);
  visit("supervisor", supervisor);
}

}  // namespace test
}  // namespace artus
