// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/haptics/actuator/control_law_supervisor.h"
#include "artus/detail/haptics/actuator/pneumatic_plant.h"

namespace artus {

// The named members of the pneumatic probe's parameters, for visit_fields (core/fields.h).

ARTUS_FIELDS(CylinderParams, moving_mass, area_P, area_N, dry_friction, viscous_friction, stroke,
             travel, polytropic, gas_constant, temperature);

ARTUS_FIELDS(ServovalveParams, sonic_conductance, critical_ratio, laminar_ratio, centre_opening,
             spool_frequency, centre_voltage, voltage_span, supply, exhaust);

ARTUS_FIELDS(SensorParams, noise, step, low, high);

ARTUS_FIELDS(ProbeSensorParams, pressure, position, force);

ARTUS_FIELDS(PneumaticParams, cylinder, valve, sensors);

ARTUS_FIELDS(PidGains, proportional, integral, derivative, integral_limit);

ARTUS_FIELDS(IpcGains, k_1, k_2, mass);

ARTUS_FIELDS(BacksteppingGains, c_1, c_2, c_3, c_4, k_3i, z_3i_limit, from_target);

ARTUS_FIELDS(ControlParams, pid, ipc, backstepping, force_filter, velocity_filter, rate);

ARTUS_FIELDS(SupervisorParams, stuck_after, supply_share, supply_after, overload_after, stop_margin,
             retry_after, blend_time);

namespace test {

/// Everything that a run of the pneumatic probe depends on.
struct ActuatorSetup {
  PneumaticParams plant;
  ControlParams control;
  SupervisorParams supervisor;
};
ARTUS_FIELDS(ActuatorSetup, plant, control, supervisor);

}  // namespace test
}  // namespace artus
