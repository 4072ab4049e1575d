// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/pneumatic_plant.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kTick = 2e-4;  // s

/// A valve that passes nothing, so that the chambers are closed.
PneumaticParams closed() {
  PneumaticParams params;
  params.valve.sonic_conductance = 1e-30;
  return params;
}

/// Polytropic energy of both chambers, J.
double gas_energy(const CylinderParams& c, const CylinderState& s) {
  return (s.p_P * c.area_P * c.length_p(s.y) + s.p_N * c.area_N * c.length_n(s.y)) /
         (c.polytropic - 1);
}

double balance(const PneumaticPlant& plant) {
  const RodEnergy& e = plant.energy();
  return e.gas + e.external + e.weight + e.friction + e.stops;
}

TEST(PneumaticPlant, AtRestNothingMovesAndThePressuresStay) {
  PneumaticPlant plant(PneumaticParams{}, ValveLayout::one);
  const CylinderState start = plant.state();
  for (int i = 0; i < 5000; ++i) plant.step({}, {}, kTick);
  EXPECT_EQ(plant.state().y, 0);
  EXPECT_NEAR(plant.state().p_P, start.p_P, 1);
  EXPECT_NEAR(plant.state().p_N, start.p_N, 1);
}

TEST(PneumaticPlant, SticksUntilThePushExceedsDryFriction) {
  PneumaticParams params = closed();
  params.cylinder.area_N = params.cylinder.area_P;  // no force of its own
  for (const double push : {5.15, 5.25}) {
    PneumaticPlant plant(params, ValveLayout::one);
    RodLoad load;
    load.force = push;
    load.inclination = std::acos(0.0);  // horizontal: no weight
    for (int i = 0; i < 500; ++i) plant.step({}, load, kTick);
    if (push < params.cylinder.dry_friction) {
      EXPECT_EQ(plant.state().y, 0);
    } else {
      EXPECT_LT(plant.state().y, 0);
    }
  }
}

TEST(PneumaticPlant, ClosedChambersAnswerASmallPushWithThePneumaticStiffness) {
  PneumaticParams params = closed();
  params.cylinder.dry_friction = 0;
  params.cylinder.area_N = params.cylinder.area_P;
  PneumaticPlant plant(params, ValveLayout::one);
  RodLoad load;
  load.force = 0.2;
  load.inclination = std::acos(0.0);
  const double stiffness = pneumatic_stiffness(params.cylinder, plant.state());
  for (int i = 0; i < 20000; ++i) plant.step({}, load, kTick);
  EXPECT_NEAR(plant.state().y, -load.force / stiffness, 1e-3 * load.force / stiffness);
}

TEST(PneumaticPlant, GravityFollowsTheInclination) {
  PneumaticParams params = closed();
  params.cylinder.dry_friction = 0;
  params.cylinder.area_N = params.cylinder.area_P;
  for (const double theta : {0.0, 0.5, 1.0, 2.5}) {
    PneumaticPlant plant(params, ValveLayout::one);
    RodLoad load;
    load.inclination = theta;
    load.mass = 0.1;
    const double stiffness = pneumatic_stiffness(params.cylinder, plant.state());
    for (int i = 0; i < 20000; ++i) plant.step({}, load, kTick);
    const double weight = (params.cylinder.moving_mass + 0.1) * kGravity * std::cos(theta);
    EXPECT_NEAR(plant.state().y, -weight / stiffness, 0.02 * std::abs(weight / stiffness)) << theta;
  }
}

TEST(PneumaticPlant, KineticEnergyIsTheSumOfAllWork) {
  PneumaticPlant plant(PneumaticParams{}, ValveLayout::one);
  double exchanged = 0;
  double last = 0;
  for (int i = 0; i < 10000; ++i) {
    const double t = i * kTick;
    RodLoad load;
    load.mass = t > 0.5 ? 1 : 0;
    load.force = 6 * std::sin(9 * t);
    plant.step({5 + 0.5 * std::sin(20 * t), 5}, load, kTick);
    EXPECT_NEAR(plant.kinetic_energy(), balance(plant), 1e-9);
    exchanged += std::abs(plant.kinetic_energy() - last);
    last = plant.kinetic_energy();
  }
  EXPECT_GT(exchanged, 0.01);
}

TEST(PneumaticPlant, FrictionAndStopsOnlyTakeEnergy) {
  PneumaticPlant plant(PneumaticParams{}, ValveLayout::one);
  RodEnergy last;
  for (int i = 0; i < 10000; ++i) {
    RodLoad load;
    load.force = 20 * std::sin(12 * i * kTick);
    plant.step({5 + 2 * std::sin(5 * i * kTick), 5}, load, kTick);
    EXPECT_LE(plant.energy().friction, last.friction + 1e-15);
    EXPECT_LE(plant.energy().stops, last.stops);
    last = plant.energy();
  }
  EXPECT_LT(last.friction, -0.01);
}

TEST(PneumaticPlant, FreeOscillationOfClosedChambersLosesEnergyAndKeepsItWithoutFriction) {
  for (const double viscous : {0.0, 5.0}) {
    PneumaticParams params = closed();
    params.cylinder.dry_friction = 0;
    params.cylinder.viscous_friction = viscous;
    params.cylinder.area_N = params.cylinder.area_P;
    PneumaticPlant plant(params, ValveLayout::one);
    RodLoad load;
    load.inclination = std::acos(0.0);
    CylinderState s = plant.state();
    s.v = 0.3;
    plant.set_state(s);
    const double mass = params.cylinder.moving_mass;
    const double rest = gas_energy(params.cylinder, s);
    const double start = mass * s.v * s.v / 2;
    for (int i = 0; i < 5000; ++i) plant.step({}, load, kTick);
    const double end = plant.kinetic_energy() + gas_energy(params.cylinder, plant.state()) - rest;
    if (viscous > 0) {
      EXPECT_LT(end, 0.01 * start);
    } else {
      EXPECT_NEAR(end, start, 0.02 * start);
    }
  }
}

TEST(PneumaticPlant, PressuresStayBetweenExhaustAndSupplyWhileTheRodIsHeld) {
  PneumaticParams params;
  params.cylinder.dry_friction = 1e6;
  PneumaticPlant plant(params, ValveLayout::two);
  for (int i = 0; i < 20000; ++i) {
    const double t = i * kTick;
    plant.step({5 + 5 * std::sin(7 * t), 5 + 5 * std::sin(11 * t)}, {}, kTick);
    for (const double p : {plant.state().p_P, plant.state().p_N}) {
      ASSERT_GE(p, params.valve.exhaust * 0.999);
      ASSERT_LE(p, params.valve.supply * 1.001);
    }
  }
}

TEST(PneumaticPlant, RodStaysWithinItsTravelUnderAnyVoltageAndLoad) {
  PneumaticPlant plant(PneumaticParams{}, ValveLayout::one);
  for (int i = 0; i < 20000; ++i) {
    RodLoad load;
    load.force = 200 * std::sin(i * 1e-3);
    plant.step({i % 3000 < 1500 ? 10.0 : 0.0, 5}, load, kTick);
    ASSERT_LE(std::abs(plant.state().y), plant.cylinder().travel);
    ASSERT_GT(plant.state().p_P, 0);
    ASSERT_GT(plant.state().p_N, 0);
  }
}

TEST(PneumaticPlant, HalvingTheSubstepChangesTheMotionLittle) {
  double y[2] = {};
  for (int k = 0; k < 2; ++k) {
    PneumaticPlant plant(PneumaticParams{}, ValveLayout::one, k == 0 ? 2e-5 : 1e-5);
    RodLoad load;
    load.force = 12;
    for (int i = 0; i < 500; ++i) plant.step({5.2, 5}, load, kTick);
    y[k] = plant.state().y;
  }
  EXPECT_NEAR(y[0], y[1], 0.01 * std::abs(y[1]));
  EXPECT_GT(std::abs(y[1]), 1e-4);
}

TEST(PneumaticPlant, SensorFeelsWeightAndInertiaOfTheLoad) {
  PneumaticPlant plant(PneumaticParams{}, ValveLayout::one);
  RodLoad load;
  load.mass = 1;
  for (int i = 0; i < 20000; ++i) plant.step({}, load, kTick);
  EXPECT_NEAR(plant.contact_force(), kGravity, 0.01);
}

}  // namespace
}  // namespace artus
