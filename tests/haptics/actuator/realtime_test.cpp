// SPDX-License-Identifier: AGPL-3.0-or-later
// The pneumatic mock and its control laws under the allocation and lock counters.
#include <memory>

#include <gtest/gtest.h>

#include "artus/detail/haptics/actuator/admittance_filter.h"
#include "artus/detail/haptics/actuator/admittance_law.h"
#include "artus/detail/haptics/actuator/backstepping_law.h"
#include "artus/detail/haptics/actuator/control_law_supervisor.h"
#include "artus/detail/haptics/actuator/ipc_law.h"
#include "artus/detail/haptics/actuator/pid_law.h"
#include "artus/detail/haptics/actuator/pneumatic_plant.h"
#include "artus/detail/haptics/actuator/pneumatic_sensors.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

using test::use;

const CylinderState kState{1e-3, 0.01, 2.5e5, 2.6e5};

TEST(RealTimeActuator, CylinderNeitherAllocatesNorLocks) {
  const CylinderParams c;
  const ChamberFlows flows{1e-5, -2e-5};
  ActiveFlows active;
  ARTUS_RUNS_REALTIME(pneumatic_force, use(pneumatic_force(c, kState)));
  ARTUS_RUNS_REALTIME(pneumatic_stiffness, use(pneumatic_stiffness(c, kState)));
  ARTUS_RUNS_REALTIME(pressure_rates, use(pressure_rates(c, kState, flows)));
  ARTUS_RUNS_REALTIME(to_active, active = to_active(c, kState.y, flows));
  ARTUS_RUNS_REALTIME(to_chambers, use(to_chambers(c, kState.y, active)));
  ARTUS_RUNS_REALTIME(force_rate, use(force_rate(c, kState, active)));
  ARTUS_RUNS_REALTIME(stiffness_rate, use(stiffness_rate(c, kState, active)));
}

TEST(RealTimeActuator, ValveAndItsMapNeitherAllocateNorLock) {
  const ServovalveParams valve;
  ARTUS_RUNS_REALTIME(orifice_flow, use(orifice_flow(valve, 0.5, 4e5, 3.99e5, 298)),
                      use(orifice_flow(valve, 0.5, 4e5, 1e5, 298)));
  ARTUS_RUNS_REALTIME(port_flow, use(port_flow(valve, 0.2, 2e5, 298)));
  ARTUS_RUNS_REALTIME(opening_of, use(opening_of(valve, 6)));
  ARTUS_RUNS_REALTIME(voltage_of, use(voltage_of(valve, 0.3)));
  ARTUS_RUNS_REALTIME(step_spool, use(step_spool(valve, 0, 0.3, 1e-3)));
  const ValveMap map(valve, {});
  ARTUS_RUNS_REALTIME(ValveMap::flow, use(map.flow(0.2, 2e5)));
  ARTUS_RUNS_REALTIME(ValveMap::find_opening, use(map.find_opening(1e-5, 2e5)));
  ARTUS_RUNS_REALTIME(ValveMap::active_flow, use(map.active_flow(0.2, 2e5, 3e5, 1e-3)));
  ARTUS_RUNS_REALTIME(ValveMap::find_active_opening,
                      use(map.find_active_opening(1e-5, 2e5, 3e5, 1e-3)));
}

TEST(RealTimeActuator, PlantAndSensorsNeitherAllocateNorLock) {
  const PneumaticParams params;
  PneumaticPlant plant(params, ValveLayout::two);
  ARTUS_RUNS_REALTIME(PneumaticPlant::step, plant.step({9, 1}, {5, 0.5, 0.1}, 5e-3));
  EXPECT_NE(plant.state().y, 0);
  ProbeSensors sensors(params.sensors, 3);
  ARTUS_RUNS_REALTIME(ProbeSensors::read, use(sensors.read(plant)));
  sensors.set_fault(ProbeSensor::force, SensorFault::lost);
  ARTUS_RUNS_REALTIME(ProbeSensors::read, use(sensors.read(plant)));
}

TEST(RealTimeActuator, FiltersNeitherAllocateNorLock) {
  LowPass filter(20, 1e-3);
  ARTUS_RUNS_REALTIME(LowPass::reset, filter.reset(1));
  ARTUS_RUNS_REALTIME(LowPass::step, use(filter.step(2)));
  Admittance admittance(true, 2, 1e-3);
  const ControlInput input{{1e-3, 2e5, 2e5, 3}, 0, {}};
  ARTUS_RUNS_REALTIME(Admittance::reset, admittance.reset(input));
  ARTUS_RUNS_REALTIME(Admittance::step, use(admittance.step(input)));
}

TEST(RealTimeActuator, LawsNeitherAllocateNorLock) {
  const PneumaticParams params;
  const ControlParams control;
  const ValveMap map(params.valve, params.cylinder);
  const ControlInput input{{1e-3, 2e5, 2e5, 3}, 0.01, {}};
  PidLaw pid(control, params.valve, true);
  IpcLaw ipc(control, params.valve, false);
  for (AdmittanceLaw* law :
       {static_cast<AdmittanceLaw*>(&pid), static_cast<AdmittanceLaw*>(&ipc)}) {
    ARTUS_RUNS_REALTIME(AdmittanceLaw::reset, law->reset(input));
    ARTUS_RUNS_REALTIME(AdmittanceLaw::step, use(law->step(input)), use(law->step(input)));
  }
  ARTUS_RUNS_REALTIME(find_stiffness_gains, use(find_stiffness_gains(0.37, 800, 100)));
  for (const bool two_valves : {false, true}) {
    BacksteppingLaw law(control, params, map, two_valves);
    ARTUS_RUNS_REALTIME(BacksteppingLaw::reset, law.reset(input));
    ARTUS_RUNS_REALTIME(BacksteppingLaw::step, use(law.step(input)), use(law.step(input)));
    ARTUS_RUNS_REALTIME(BacksteppingLaw::active_flow, use(law.active_flow(kState, input.target)));
  }
}

TEST(RealTimeActuator, SupervisorNeitherAllocatesNorLocksUnderAnyLawOrFault) {
  const PneumaticParams params;
  PneumaticPlant plant(params, ValveLayout::two);
  ProbeSensors sensors(params.sensors, 11);
  ControlSupervisor supervisor({}, params, {}, ControlLawKind::pid);
  std::uint32_t seen = 0;
  const auto run = [&](int ticks) {
    for (int k = 0; k < ticks; ++k) {
      const ControlTick& tick = supervisor.step(sensors.read(plant), {});
      seen |= tick.status;
      plant.step(tick.command, {}, supervisor.period());
    }
  };
  for (std::size_t i = 0; i < kControlLaws; ++i) {
    ARTUS_RUNS_REALTIME(ControlSupervisor::select,
                        supervisor.select(static_cast<ControlLawKind>(i)));
    sensors.set_fault(ProbeSensor::position, SensorFault::none);
    ARTUS_RUNS_REALTIME(ControlSupervisor::step, run(100), use(supervisor.step({}, {})));
    sensors.set_fault(ProbeSensor::position, SensorFault::lost);
    ARTUS_RUNS_REALTIME(ControlSupervisor::step, run(20), use(supervisor.step({}, {})));
  }
  EXPECT_NE(seen & ControlStatus::kSensorLost, 0U);
}

}  // namespace
}  // namespace artus
