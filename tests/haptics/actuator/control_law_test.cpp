// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/control_law.h"

#include <cmath>
#include <set>
#include <string>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/haptics/actuator/ipc_law.h"
#include "artus/detail/haptics/actuator/pid_law.h"
#include "artus/detail/haptics/actuator/pneumatic_cylinder.h"

namespace artus {
namespace {

ControlParams unfiltered() {
  ControlParams control;
  control.force_filter = 0;
  control.velocity_filter = 0;
  return control;
}

ControlInput input_at(double y, double force = 0) {
  ControlInput input;
  input.measured = {y, 3e5, 3e5, force};
  input.target.stiffness = 500;
  return input;
}

TEST(ControlLaw, NamesAreUniqueAndFoundAgain) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < kControlLaws; ++i) {
    const auto kind = static_cast<ControlLawKind>(i);
    names.insert(to_string(kind));
    EXPECT_EQ(find_control_law(to_string(kind)).value(), kind);
  }
  EXPECT_EQ(names.size(), kControlLaws);
  EXPECT_THAT(find_control_law("fuzzy").error().message, testing::HasSubstr("admittance-pid"));
}

TEST(ControlLaw, OnlyAdmittanceLawsNeedTheForceSensor) {
  EXPECT_TRUE(needs_force_sensor(ControlLawKind::admittance_pid));
  EXPECT_TRUE(needs_force_sensor(ControlLawKind::admittance_ipc));
  EXPECT_FALSE(needs_force_sensor(ControlLawKind::pid));
  EXPECT_FALSE(needs_force_sensor(ControlLawKind::backstepping_one_valve));
}

TEST(PidLaw, ConstantErrorGivesTheProportionalAndTheGrowingIntegralPart) {
  const ControlParams control = unfiltered();
  PidLaw law(control, {}, false);
  const ControlInput input = input_at(-0.002);
  law.reset(input);
  double u = 0;
  const int n = 5000;
  for (int i = 0; i < n; ++i) u = law.step(input).command.u_P;
  const double expected = 5 + 60 * 0.002 + 5 * 0.002 * n / control.rate;
  EXPECT_NEAR(u, expected, 1e-12);
}

TEST(PidLaw, RampGivesTheDerivativePart) {
  ControlParams control = unfiltered();
  control.pid.proportional = 0;
  control.pid.integral = 0;
  PidLaw law(control, {}, false);
  const double speed = 0.01;
  law.reset(input_at(0));
  for (int i = 1; i < 10; ++i) {
    const double u = law.step(input_at(-speed * i / control.rate)).command.u_P;
    EXPECT_NEAR(u, 5 + 20 * speed, 1e-9);
  }
}

TEST(PidLaw, IntegralStopsWhileTheValveIsSaturated) {
  const ControlParams control = unfiltered();
  PidLaw law(control, {}, false);
  law.reset(input_at(-0.2));
  for (int i = 0; i < 50000; ++i) EXPECT_EQ(law.step(input_at(-0.2)).command.u_P, 10);
  // Back at the target nothing but the derivative's kick may remain.
  static_cast<void>(law.step(input_at(0)));
  EXPECT_NEAR(law.step(input_at(0)).command.u_P, 5, 1e-9);
}

TEST(Admittance, ForceMovesTheReferenceByForceOverStiffness) {
  for (const auto kind : {ControlLawKind::admittance_pid, ControlLawKind::admittance_ipc}) {
    const PneumaticParams plant;
    const ValveMap map(plant.valve, plant.cylinder);
    const auto law = make_control_law(kind, ControlParams{}, plant, map);
    const ControlInput input = input_at(0, 5);
    law->reset(input);
    ControlOutput out;
    for (int i = 0; i < 10000; ++i) out = law->step(input);
    EXPECT_NEAR(out.reference, -5.0 / 500, 1e-9);
  }
}

TEST(IpcLaw, HeldRodSettlesAtTheSpringsInSeries) {
  const ControlParams control = unfiltered();
  IpcLaw law(control, {}, false);
  law.reset(input_at(0));
  double u = 0;
  for (int i = 0; i < 50000; ++i) u = law.step(input_at(-0.01)).command.u_P;
  // k_2 (x - y) with x between its springs: k_1 k_2/(k_1 + k_2) times the distance.
  EXPECT_NEAR(u, 5 + 55.0 * 100 / 155 * 0.01, 1e-9);
}

TEST(IpcLaw, VirtualMassDoesNotOvershootWithCriticalDamping) {
  const ControlParams control = unfiltered();
  IpcLaw law(control, {}, false);
  law.reset(input_at(0));
  ControlInput input = input_at(0);
  input.target.y = 0.01;
  double last = 5;
  for (int i = 0; i < 50000; ++i) {
    const double u = law.step(input).command.u_P;
    ASSERT_GE(u, last - 1e-12);
    last = u;
  }
  EXPECT_NEAR(last, 5 + 55.0 * 100 / 155 * 0.01, 1e-9);
}

TEST(IpcLaw, NeverGivesMoreEnergyThanItsSpringsHold) {
  // Passivity at the rod's port: the work of the virtual spring's force on a rod moved at will
  // never exceeds what was put in. The reference stands still.
  const ControlParams control = unfiltered();
  const IpcGains gains;
  IpcLaw law(control, {}, false);
  law.reset(input_at(0));
  const double dt = 1 / control.rate;
  double work = 0;  // J given to the rod, per V/m as N/m
  double y = 0;
  for (int i = 0; i < 200000; ++i) {
    const double t = i * dt;
    const double next =
        0.01 * std::sin(3 * t) + 0.004 * std::sin(17 * t + 1) - 0.004 * std::sin(1.0);
    const double force = law.step(input_at(y)).command.u_P - 5;
    work += force * (next - y);
    y = next;
    ASSERT_LE(work, 1e-5) << t;
  }
  EXPECT_LT(work, -1e-3);
  EXPECT_NEAR(gains.damping(), 2 * std::sqrt(155 * 0.4), 1e-12);
}

TEST(ControlLaw, AtTheTargetAllLawsKeepTheValveNearTheCentre) {
  const PneumaticParams plant;
  const ValveMap map(plant.valve, plant.cylinder);
  for (std::size_t i = 0; i < kControlLaws; ++i) {
    const auto law = make_control_law(static_cast<ControlLawKind>(i), ControlParams{}, plant, map);
    ControlInput input = input_at(0);
    // The pressures whose force carries the rod's weight, at the wanted stiffness of the chambers.
    input.measured.p_P = (kGravity * 0.37 + 65.974e-6 * 3e5) / 78.54e-6;
    input.target.pneumatic =
        pneumatic_stiffness(plant.cylinder, {0, 0, input.measured.p_P, input.measured.p_N});
    law->reset(input);
    const double u = law->step(input).command.u_P;
    EXPECT_NEAR(u, 5, 0.1) << i;
  }
}

}  // namespace
}  // namespace artus
