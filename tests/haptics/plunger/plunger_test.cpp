// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/plunger.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "tests/haptics/plunger/plunger_fixture.h"

namespace artus {
namespace {

using namespace test;

double needle_resistance() {
  const PlungerParams params = water_syringe(0);
  return NeedleFlow(params.needle, params.liquid.viscosity, 1000, 0).resistance();
}

/// Opens and peaks at these, Pa, the peak at `peak_volume` m^3.
SpaceLaw tissue_that_parts(double opening, double peak, double peak_volume) {
  SpaceLaw law;
  law.kind = SpaceKind::split;
  law.opening = opening;
  law.peak = peak;
  law.peak_volume = peak_volume;
  return law;
}

TEST(Plunger, FillsAComplianceAtConstantPressureByAnExponential) {
  for (const double rate : {1e3, 2e3, 10e3}) {
    PlungerParams params = water_syringe(0);
    params.syringe.break_loose = params.syringe.glide;
    Plunger plunger(params, one_space(compliance(kRest, 1 / kCompliance)), 1 / rate);
    const double over = 50 * kMercury;
    const double force = params.syringe.glide + params.syringe.area() * (kRest + over);
    const double tau = needle_resistance() * kCompliance;
    double worst = 0;
    for (int k = 1; k <= 100 * static_cast<int>(rate); ++k) {
      plunger.step(thumb(force));
      const double wanted = kCompliance * over * (1 - std::exp(-k / rate / tau));
      worst = std::max(worst, std::abs(plunger.states()[0].volume - wanted));
    }
    EXPECT_LT(worst, 1e-3 * kCompliance * over) << rate;
  }
}

TEST(Plunger, FlowsOnAfterItStoppedWithTheTimeOfItsTrappedAir) {
  for (const double rate : {1e3, 2e3, 10e3}) {
    PlungerParams params = water_syringe(0);
    params.syringe.compliance = 0;
    params.syringe.air = 0.2 * kCubicCentimetre;
    params.syringe.break_loose = 7;
    params.syringe.glide = 0;
    Plunger plunger(params, one_space(compliance(0, 1 / kCompliance)), 1 / rate);
    plunger.step(thumb(8));  // the stopper goes, the air is pressed
    plunger.step(thumb(4));  // it sticks from here on
    // Boyle's law: what is in the barrel runs out through the bore, by many small steps.
    const double v0 = plunger.states()[0].volume;
    const double whole = params.syringe.squeezed(plunger.state().pressure) + v0;
    const auto flow = [&](double v) {
      const double left = (whole - v) / params.syringe.air;  // of the air, that is pressed away
      const double pressure = Syringe::kAtmosphere * left / (1 - left);
      return (pressure - v / kCompliance) / needle_resistance();
    };
    constexpr double kSmall = 1e-5;  // s
    double volume = v0;
    double worst = 0;
    for (int k = 1; k <= static_cast<int>(rate); ++k) {
      plunger.step(thumb(4));
      for (int n = 0; n < static_cast<int>(std::lround(1 / (rate * kSmall))); ++n)
        volume += kSmall * flow(volume + kSmall / 2 * flow(volume));
      worst = std::max(worst, std::abs(plunger.states()[0].volume - volume));
    }
    EXPECT_GT(volume - v0, 0.03 * kCubicCentimetre);
    EXPECT_LT(worst, 1e-3 * (volume - v0)) << rate;
  }
}

/// 0.5 ml under 192 kPa: 0.5 192 / 293.3 = 0.327 of air and 0.192 of the barrel.
TEST(Plunger, TrappedAirIsPressedAndDrawnByBoylesLaw) {
  Syringe syringe;
  syringe.air = 0.5e-6;
  EXPECT_NEAR(syringe.squeezed(192e3), 0.519e-6, 0.5e-9);
  EXPECT_NEAR(syringe.squeezed(-35e3), -0.299e-6, 0.5e-9);
  for (const double compliance : {0.0, 1e-12})
    for (const double p : {-95e3, -35e3, -1.0, 0.0, 1e-3, 1.0, 192e3, 5e6}) {
      syringe.compliance = compliance;
      EXPECT_NEAR(syringe.pressure_of(syringe.squeezed(p)), p, 1e-9 * std::abs(p)) << p;
      const double h = 1;  // Pa
      EXPECT_NEAR((syringe.squeezed(p + h) - syringe.squeezed(p - h)) / (2 * h),
                  syringe.softness(p), 1e-6 * syringe.softness(p));
    }
}

TEST(Plunger, LeaksOverAYieldPressureByTheTwoResistances) {
  PlungerParams params = water_syringe(0);
  params.grip = 1e9;
  params.syringe.break_loose = params.syringe.glide;
  std::vector<Space> spaces = one_space(compliance(100 * kMercury, 1 / 2e-12));
  spaces[0].leaks_to = "sink";
  spaces[0].leak_opening = 100 * kMercury;
  spaces[0].leak_resistance = 2e10;
  spaces.push_back(one_space(level(0), "sink")[0]);
  Plunger plunger(params, spaces, 1e-3);
  const double force = params.syringe.glide + params.syringe.area() * (100 * kMercury + 2e4);
  for (int k = 0; k < 5000; ++k) plunger.step(thumb(force));
  EXPECT_NEAR(plunger.state().flow / (2e4 / (needle_resistance() + 2e10)), 1, 1e-3);
  EXPECT_NEAR(plunger.state().flow / kCubicCentimetre, 0.2222, 2e-4);
}

TEST(Plunger, SpendsTheThumbsWorkOnFrictionNeedleTargetAndBarrel) {
  PlungerParams params = water_syringe(0);
  constexpr double kDt = 1e-4;
  Plunger plunger(params, one_space(compliance(kRest, 1 / kCompliance)), kDt);
  const double force = 2 + params.syringe.area() * (kRest + 50 * kMercury) + 2;
  double needle = 0;
  for (int k = 0; k < 50000; ++k) {
    const double q = plunger.step(thumb(force)).flow;
    needle += q * q * needle_resistance() * kDt;
  }
  const double x = plunger.state().travel;
  const double v = plunger.states()[0].volume;
  const double p = plunger.state().pressure;
  const double target = kRest * v + v * v / (2 * kCompliance);
  // A step of force on a spring: half is stored, half is lost at once.
  const double barrel = params.syringe.softness() * p * p;
  const double rest = force * x - params.syringe.glide * x - needle - target - barrel;
  EXPECT_LT(std::abs(rest), 1e-3 * force * x);
}

TEST(Plunger, LosesTheDifferenceOfPressuresOnItsAreaAtAConstantRate) {
  PlungerParams params = water_syringe();
  std::vector<Space> spaces = one_space(level(300e3), "tendon");
  spaces.push_back(one_space(level(20 * kMercury), "bursa")[0]);
  Plunger plunger(params, spaces, 1e-3);
  PlungerInput input = thumb(0);
  input.stiffness = 2000;
  const double speed = 1e-7 / params.syringe.area();
  double before = 0;
  for (int k = 0; k < 40000; ++k) {
    if (k == 25000) {
      before = plunger.state().force;
      input.tip[0].space = 1;
    }
    input.position = 37.2 / 2000 + speed * 1e-3 * k;
    plunger.step(input);
  }
  const double fall = before - plunger.state().force;
  EXPECT_NEAR(fall / (params.syringe.area() * (300e3 - 20 * kMercury)), 1, 2e-3);
  EXPECT_NEAR(fall, 34.0, 0.1);
}

TEST(Plunger, GainsFlowByTheDifferenceOfPressuresAtAConstantForce) {
  PlungerParams params = water_syringe(0);
  std::vector<Space> spaces = one_space(level(20e3), "muscle");
  spaces.push_back(one_space(level(20 * kMercury), "bursa")[0]);
  Plunger plunger(params, spaces, 1e-3);
  for (int k = 0; k < 100; ++k) plunger.step(thumb(6));
  const double before = plunger.state().flow;
  PlungerInput input = thumb(6);
  input.tip[0].space = 1;
  plunger.step(input);
  EXPECT_NEAR((plunger.state().flow - before) / ((20e3 - 20 * kMercury) / needle_resistance()), 1,
              1e-3);
}

/// A wild thumb over two places at once, with leaks and a rupture.
double unbalanced_volume(double rate, std::uint64_t seed) {
  PlungerParams params = water_syringe();
  params.needle = *bore_of_gauge(18, 0.04);
  SpaceLaw law = compliance(-3e3, 3e9);
  law.relaxing = 0.5;
  law.relaxation = 30;
  law.yield = 4e-6;
  law.rupture = 6e-6;
  std::vector<Space> spaces = one_space(law, "joint");
  spaces[0].leaks_to = "bursa";
  spaces.push_back(one_space(compliance(1e3, 1.5e9), "bursa")[0]);
  Plunger plunger(params, spaces, 1 / rate);
  PlungerInput input;
  for (int k = 0; k < static_cast<int>(10 * rate); ++k) {
    const auto phase = static_cast<std::uint64_t>(k / (0.25 * rate));
    input.force = 60 * (uniform_noise(seed, phase) - 0.3);
    const double share = uniform_noise(seed + 1, phase);
    input.tip = {{{0, share}, {1, 1 - share}}};
    plunger.step(input);
  }
  double in = 0;
  for (const SpaceState& s : plunger.states()) in += s.volume - s.drawn;
  EXPECT_GT(plunger.states()[0].volume + plunger.states()[1].volume, 0);
  const PlungerState& state = plunger.state();
  const double left = params.syringe.filled - state.content;
  EXPECT_LT(std::abs(in - left), 1e-15);
  return in - (params.syringe.area() * state.travel - params.syringe.softness() * state.pressure);
}

TEST(Plunger, KeepsEveryVolumeToOneBillionthOfAMillilitre) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    EXPECT_LT(std::abs(unbalanced_volume(1e3, seed)), 1e-15) << seed;
  EXPECT_LT(std::abs(unbalanced_volume(10e3, 7)), 1e-15);
}

TEST(Plunger, SeesBloodAfterTheHubAtTheTimesOfTheReference) {
  // At -40 kPa, blood of 3.5 mPa s, hub of 0.07 ml, needles of 40, 50, 50 and 38 mm.
  struct Row {
    int gauge;
    double length;
    double time;  // s, 0.07 ml over the flow of Hagen and Poiseuille
  };
  for (const Row& row :
       {Row{18, 0.04, 0.0203}, Row{21, 0.05, 0.178}, Row{22, 0.05, 0.429}, Row{25, 0.038, 2.07}}) {
    PlungerParams params = water_syringe(0);
    params.syringe.filled = 1e-6;
    params.needle = *bore_of_gauge(row.gauge, row.length);
    params.liquids = {Liquid{"blood", {3.5e-3, 3.5e-3, 0, 1}, 1055, "blood", 0, 0, 0, ""}};
    std::vector<Space> spaces = one_space(level(0), "vein");
    spaces[0].liquid = "blood";
    spaces[0].law.contents = 1;
    Plunger plunger(params, spaces, 1e-4);
    const double pull = -(40e3 * params.syringe.area() + params.syringe.glide);
    int k = 0;
    while ((plunger.step(thumb(pull)).status & PlungerStatus::kFlash) == 0 && k < 100000) ++k;
    EXPECT_NEAR(1e-4 * k / row.time, 1, 0.02) << row.gauge;
    EXPECT_GT(plunger.state().drawn, params.syringe.dead_space);
  }
}

TEST(Plunger, DrawsNothingFromTissueAndCannotPullMoreThanAVacuum) {
  const SpaceLaw law = tissue_that_parts(8e3, 20e3, 1e-7);
  PlungerParams params = water_syringe();
  params.syringe.filled = 5e-6;
  Plunger plunger(params, one_space(law), 1e-3);
  for (int k = 0; k < 3000; ++k) plunger.step(thumb(-80));
  EXPECT_EQ(plunger.state().drawn, 0);
  EXPECT_GE(plunger.state().pressure, -90e3 - 1);
  EXPECT_NE(plunger.state().status & PlungerStatus::kLimited, 0U);
}

TEST(Plunger, WashesSlurryOutOfADepositThatItHasOpenedALittleLessEachTime) {
  SpaceLaw law = tissue_that_parts(100e3, 200e3, 2e-8);
  law.contents = 0.16e-6;
  PlungerParams params = water_syringe();
  params.syringe.filled = 5e-6;
  params.liquids = {Liquid{"slurry", {20e-3, 20e-3, 0, 1}, 1400, "fluid", 0, 0, 0, ""}};
  std::vector<Space> spaces = one_space(law);
  spaces[0].liquid = "slurry";
  Plunger plunger(params, spaces, 1e-3);
  for (int k = 0; k < 1000; ++k) plunger.step(thumb(-10));
  EXPECT_EQ(plunger.state().drawn, 0) << "not opened yet";
  double before = 0;
  double washed = law.contents;
  for (int wash = 0; wash < 4; ++wash) {
    for (int k = 0; k < 20000 && plunger.states()[0].volume < 0.5e-6; ++k) plunger.step(thumb(40));
    EXPECT_GE(plunger.states()[0].volume, 0.5e-6);
    for (int k = 0; k < 3000; ++k) plunger.step(thumb(-10));
    const SpaceState& s = plunger.states()[0];
    const double now = plunger.state().drawn - before;
    EXPECT_GT(now, 0) << wash;
    EXPECT_LT(now, washed) << wash;
    EXPECT_LE(s.drawn, law.contents);
    EXPECT_NEAR(s.volume - s.drawn, 5e-6 - plunger.state().content, 1e-15);
    washed = now;
    before = plunger.state().drawn;
  }
  EXPECT_GT(plunger.state().drawn, 0.9 * law.contents);
  EXPECT_NE(plunger.state().status & PlungerStatus::kFlash, 0U) << "a cloud in the syringe";
}

TEST(Plunger, OpensATendonOnlyAboveItsOpeningPressureAndForgetsWhenTheTipMoved) {
  const SpaceLaw law = tissue_that_parts(150e3, 300e3, 5e-8);
  PlungerParams params = water_syringe();
  Plunger plunger(params, one_space(law), 1e-3);
  for (int k = 0; k < 1000; ++k) plunger.step(thumb(15));
  EXPECT_EQ(plunger.states()[0].volume, 0);
  EXPECT_NE(plunger.state().status & PlungerStatus::kClosed, 0U);
  for (int k = 0; k < 1000; ++k) plunger.step(thumb(30));
  EXPECT_GT(plunger.states()[0].volume, 0);
  for (int k = 0; k < 500; ++k) plunger.step(thumb(0));
  PlungerInput moved = thumb(0);
  moved.depth = 0.6e-3;
  plunger.step(moved);
  EXPECT_FALSE(plunger.states()[0].open);
}

TEST(Plunger, WrongUseIsToldAndLosesNothing) {
  PlungerParams params = water_syringe();
  params.syringe.filled = 1e-6;
  Plunger plunger(params, one_space(level(0), std::string(kOutsideSpace)), 1e-3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  plunger.step(thumb(nan));
  EXPECT_NE(plunger.state().status & PlungerStatus::kNotFinite, 0U);
  EXPECT_EQ(plunger.state().force, 0);
  plunger.step(thumb(1e30));
  EXPECT_NE(plunger.state().status & PlungerStatus::kLimited, 0U);
  EXPECT_LE(plunger.state().force, params.max_force);
  for (int k = 0; k < 30000; ++k) plunger.step(thumb(20));
  EXPECT_NE(plunger.state().status & PlungerStatus::kEmpty, 0U);
  EXPECT_NE(plunger.state().status & PlungerStatus::kOutside, 0U);
  EXPECT_NEAR(plunger.states()[0].volume + plunger.state().content, 1e-6, 1e-15);
}

TEST(Plunger, BeyondItsCapacityASpaceTearsAndLosesPressureButNoVolume) {
  SpaceLaw law = compliance(0, 4e9);
  law.yield = 2e-6;
  law.rupture = 3e-6;
  PlungerParams params = water_syringe();
  Plunger plunger(params, one_space(law), 1e-3);
  double highest = 0;
  for (int k = 0; k < 60000; ++k) {
    plunger.step(thumb(12));
    highest = std::max(highest, plunger.pressure(0));
  }
  EXPECT_NE(plunger.state().status & PlungerStatus::kRuptured, 0U);
  EXPECT_LT(plunger.pressure(0), 0.5 * highest);
  const double around = plunger.states().back().volume;
  EXPECT_GT(around, 0);
  EXPECT_NEAR(plunger.states()[0].volume + around, 50e-6 - plunger.state().content, 1e-15);
}

TEST(Plunger, ATornSpaceKeepsWhatItsSlackWallsHold) {
  // A fifth of the walls' tension against the 1 kPa that parts what lies around: 5 kPa of the
  // curve.
  SpaceLaw bursa = compliance(1066.6, 1.48136e9);
  bursa.yield = 15e-6;
  bursa.rupture = 20e-6;
  SpaceLaw joint = compliance(0, 2.66644e9);
  joint.slack = 3e-6;
  joint.toe = 5e-6;
  joint.yield = 9e-6;
  joint.rupture = 11e-6;
  for (const auto& [law, kept] : {std::pair(bursa, 5e3 / 1.48136e9),
                                  std::pair(joint, 3e-6 + std::sqrt(2 * 5e-6 * 5e3 / 2.66644e9))}) {
    Plunger plunger(water_syringe(), one_space(law), 1e-3);
    for (int k = 0; k < 200000 && (plunger.state().status & PlungerStatus::kRuptured) == 0; ++k)
      plunger.step(thumb(12));
    ASSERT_NE(plunger.state().status & PlungerStatus::kRuptured, 0U);
    for (int k = 0; k < 90000; ++k) plunger.step(thumb(0));
    EXPECT_NEAR(plunger.states()[0].volume / kept, 1, 0.01);
    EXPECT_NEAR(plunger.pressure(0) - law.rest, 1e3, 10);
  }
}

TEST(Plunger, GrainsClogAThinNeedleAtRestAndShakingFreesIt) {
  PlungerParams params = water_syringe();
  params.liquid.solids = 0.03;
  for (const int gauge : {22, 27}) {
    params.needle = *bore_of_gauge(gauge, 0.03);
    Plunger plunger(params, one_space(level(0)), 1e-3);
    for (int k = 0; k < 200000; ++k) plunger.step(thumb(0));
    for (int k = 0; k < 500; ++k) plunger.step(thumb(20));
    const bool clogged = (plunger.state().status & PlungerStatus::kClogged) != 0;
    EXPECT_EQ(clogged, gauge == 27);
    if (!clogged) continue;
    const double flow = plunger.state().flow;
    plunger.clear_needle();
    for (int k = 0; k < 10; ++k) plunger.step(thumb(20));
    EXPECT_GT(plunger.state().flow, 20 * flow);
  }
}

TEST(Plunger, RelaxesByItsShareWithinItsTime) {
  SpaceLaw law = compliance(0, 2.66644e9);
  law.relaxing = 0.5;
  law.relaxation = 30;
  PlungerParams params = water_syringe();
  Plunger plunger(params, one_space(law), 1e-3);
  while (plunger.states()[0].volume < 5e-6) plunger.step(thumb(25));
  PlungerInput away = thumb(0);
  away.tip = {};
  const double first = plunger.states()[0].relaxing;
  for (int k = 0; k < 30000; ++k) plunger.step(away);
  EXPECT_NEAR(plunger.states()[0].relaxing / first, std::exp(-1), 1e-3);
}

}  // namespace
}  // namespace artus
