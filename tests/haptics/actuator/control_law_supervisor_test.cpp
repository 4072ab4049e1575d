// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/control_law_supervisor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "artus/detail/haptics/actuator/pneumatic_plant.h"
#include "tests/support/no_alloc.h"

namespace artus {
namespace {

/// The whole actuator: mock, sensors, supervised laws.
struct Bench {
  explicit Bench(ControlLawKind kind) : supervisor({}, params, {}, kind) {
    target.stiffness = kind >= ControlLawKind::backstepping_one_valve ? 1500 : 700;
  }

  const ControlTick& step() {
    const ValveCommand before = tick.command;
    tick = supervisor.step(sensors.read(plant), target);
    jump =
        std::max(std::abs(tick.command.u_P - before.u_P), std::abs(tick.command.u_N - before.u_N));
    plant.step(tick.command, load, supervisor.period());
    return tick;
  }

  void run(double seconds) {
    const auto n = std::lround(seconds / supervisor.period());
    largest_jump = 0;
    fastest = 0;
    faults = 0;
    for (long i = 0; i < n; ++i) {
      step();
      largest_jump = std::max(largest_jump, jump);
      fastest = std::max(fastest, std::abs(plant.state().v));
      faults |= tick.status & ControlStatus::kFaults;
    }
  }

  PneumaticParams params;
  PneumaticPlant plant{params, ValveLayout::two};
  ProbeSensors sensors{params.sensors, 11};
  ControlSupervisor supervisor;
  ProbeTarget target;
  RodLoad load;
  ControlTick tick;
  double jump = 0;           // V, between the last two commands
  double largest_jump = 0;   // V, of the last run
  double fastest = 0;        // m/s, of the last run
  std::uint32_t faults = 0;  // seen in the last run
};

void expect_centre(const ControlTick& tick) {
  EXPECT_EQ(tick.command.u_P, 5);
  EXPECT_EQ(tick.command.u_N, 5);
}

class EveryLaw : public testing::TestWithParam<ControlLawKind> {};

TEST_P(EveryLaw, RunsWithoutFaultOnASoundActuator) {
  Bench bench(GetParam());
  bench.run(1);
  EXPECT_EQ(bench.faults, 0U);
  bench.load.force = 6;
  bench.run(2);
  EXPECT_EQ(bench.faults, 0U);
}

TEST_P(EveryLaw, SensorFaultCentresTheValveAndRecoversWithoutAJump) {
  for (const SensorFault fault :
       {SensorFault::not_a_number, SensorFault::lost, SensorFault::stuck}) {
    Bench bench(GetParam());
    bench.load.force = 6;
    bench.run(1.5);
    ASSERT_EQ(bench.faults, 0U);
    bench.run(0.1);
    const double usual = bench.largest_jump;
    bench.sensors.set_fault(ProbeSensor::position, fault);
    bench.run(0.4);
    const std::uint32_t expected = fault == SensorFault::not_a_number ? ControlStatus::kNotFinite
                                   : fault == SensorFault::lost       ? ControlStatus::kSensorLost
                                                                      : ControlStatus::kSensorStuck;
    EXPECT_EQ(bench.tick.status & ControlStatus::kFaults, expected);
    expect_centre(bench.tick);
    EXPECT_LT(bench.fastest, 0.2);
    EXPECT_LE(std::abs(bench.plant.state().y), bench.params.cylinder.travel);
    bench.sensors.set_fault(ProbeSensor::position, SensorFault::none);
    bench.run(3);
    EXPECT_EQ(bench.tick.status & ControlStatus::kFaults, 0U);
    EXPECT_LT(bench.largest_jump, usual + 0.1);
    EXPECT_LT(bench.fastest, 0.2);
  }
}

INSTANTIATE_TEST_SUITE_P(ControlSupervisor, EveryLaw,
                         testing::Values(ControlLawKind::pid, ControlLawKind::admittance_pid,
                                         ControlLawKind::ipc, ControlLawKind::admittance_ipc,
                                         ControlLawKind::backstepping_one_valve,
                                         ControlLawKind::backstepping_two_valves));

TEST(ControlSupervisor, EverySensorOfTheLawIsWatched) {
  for (const auto kind : {ControlLawKind::admittance_ipc, ControlLawKind::backstepping_one_valve}) {
    for (std::size_t i = 0; i < kProbeSensors; ++i) {
      for (const auto fault : {SensorFault::not_a_number, SensorFault::lost, SensorFault::stuck}) {
        const auto sensor = static_cast<ProbeSensor>(i);
        Bench bench(kind);
        bench.run(0.2);
        bench.sensors.set_fault(sensor, fault);
        bench.run(0.2);
        const bool unused = sensor == ProbeSensor::force && !needs_force_sensor(kind);
        EXPECT_EQ(bench.faults == 0, unused) << i;
      }
    }
  }
}

TEST(ControlSupervisor, ExchangingLawsNeverJumps) {
  Bench bench(ControlLawKind::admittance_pid);
  bench.load.force = 6;
  bench.run(2);
  double usual = 0;
  for (std::size_t round = 0; round < 3 * kControlLaws; ++round) {
    bench.run(0.5);
    usual = std::max(usual, bench.largest_jump);
    bench.supervisor.select(static_cast<ControlLawKind>((round * 5 + 2) % kControlLaws));
    bench.step();
    EXPECT_LT(bench.jump, 1e-12) << round;
    EXPECT_EQ(bench.tick.status & ControlStatus::kFaults, 0U);
    bench.run(0.5);
    EXPECT_LT(bench.fastest, 0.3) << round;
  }
}

TEST(ControlSupervisor, LostSupplyIsSeenAndRecoveredFrom) {
  for (const auto kind : {ControlLawKind::admittance_pid, ControlLawKind::admittance_ipc,
                          ControlLawKind::backstepping_one_valve}) {
    Bench bench(kind);
    bench.load.force = 4;
    bench.run(1);
    bench.plant.set_supply(1e5);
    bench.run(2);
    EXPECT_EQ(bench.tick.status & ControlStatus::kFaults, ControlStatus::kSupplyLost);
    expect_centre(bench.tick);
    bench.plant.set_supply(4e5);
    bench.run(3);
    EXPECT_EQ(bench.tick.status & ControlStatus::kFaults, 0U);
    EXPECT_LT(bench.fastest, 0.3);
    EXPECT_LT(std::abs(bench.plant.state().y - bench.tick.reference), 0.012);
  }
}

TEST(ControlSupervisor, LoadBeyondCapacityCentresTheValveAndTheRodComesBackSlowly) {
  for (const auto kind : {ControlLawKind::admittance_pid, ControlLawKind::admittance_ipc,
                          ControlLawKind::backstepping_one_valve}) {
    Bench bench(kind);
    bench.run(0.5);
    bench.load.force = 45;
    bench.run(2);
    EXPECT_NE(bench.faults & ControlStatus::kOverload, 0U);
    EXPECT_LE(std::abs(bench.plant.state().y), bench.params.cylinder.travel);
    bench.load.force = 0;
    bench.run(4);
    EXPECT_EQ(bench.tick.status & ControlStatus::kFaults, 0U);
    EXPECT_LT(bench.fastest, 0.5);
    EXPECT_LT(std::abs(bench.plant.state().y), 5e-3);
  }
}

TEST(ControlSupervisor, TargetThatMakesNoSenseIsRefusedAndTheLastOneStays) {
  Bench bench(ControlLawKind::backstepping_one_valve);
  bench.run(0.2);
  bench.target.stiffness = std::numeric_limits<double>::quiet_NaN();
  bench.run(0.2);
  EXPECT_NE(bench.tick.status & ControlStatus::kTargetRefused, 0U);
  EXPECT_EQ(bench.faults, 0U);
  bench.target.stiffness = 0.2;  // finite, but below the moving mass: (3.41)
  bench.run(0.2);
  EXPECT_NE(bench.tick.status & ControlStatus::kTargetRefused, 0U);
  EXPECT_TRUE(std::isfinite(bench.tick.command.u_P));
}

TEST(ControlSupervisor, ForceIsEstimatedFromThePressuresWithinDryFriction) {
  Bench bench(ControlLawKind::backstepping_one_valve);
  bench.load.force = 9;
  bench.run(2);
  EXPECT_NEAR(bench.tick.estimated_force, 9, bench.params.cylinder.dry_friction + 0.3);
}

TEST(ControlSupervisor, SameSeedGivesTheSameBytes) {
  Bench a(ControlLawKind::backstepping_one_valve);
  Bench b(ControlLawKind::backstepping_one_valve);
  a.run(0.5);
  b.run(0.5);
  EXPECT_EQ(a.plant.state().p_P, b.plant.state().p_P);
  EXPECT_EQ(a.tick.command.u_P, b.tick.command.u_P);
}

TEST(ControlSupervisor, TickAllocatesNothing) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP() << "sanitizer build";
  for (std::size_t i = 0; i < kControlLaws; ++i) {
    Bench bench(static_cast<ControlLawKind>(i));
    bench.step();
    long count = -1;
    {
      const test::AllocationCounter counter;
      for (int k = 0; k < 200; ++k) {
        bench.step();
        if (k == 100) bench.supervisor.select(ControlLawKind::pid);
        if (k == 150) bench.sensors.set_fault(ProbeSensor::position, SensorFault::lost);
      }
      count = counter.count();
    }
    EXPECT_EQ(count, 0);
  }
}

}  // namespace
}  // namespace artus
