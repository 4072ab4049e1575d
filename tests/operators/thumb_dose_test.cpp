// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/operators/thumb_dose.h"

#include <gtest/gtest.h>

#include "tests/support/real_time.h"

namespace artus {
namespace {

constexpr double kDoseDt = 1e-3;  // s

/// What a real plunger gives while the thumb holds it, m^3, into a place of one pressure.
double given_while_held(double air, double push, double place) {
  PlungerParams params;
  params.syringe.air = air;
  params.liquid.density = 1000;
  Space space;
  space.name = space.like = "place";
  space.law.rest = place;
  Plunger plunger(params, {space}, kDoseDt);
  PlungerInput input;
  input.tip[0] = {0, 1};
  input.force = push;
  for (int k = 0; k < 3000; ++k) plunger.step(input);
  const PlungerState at = plunger.state();
  const double before = plunger.states()[0].volume;
  for (int k = 0; k < 20000; ++k) {
    input.force = params.syringe.area() * plunger.state().pressure;
    plunger.step(input);
  }
  const double after = plunger.states()[0].volume - before;
  const double told = after_flow(params.syringe, at.pressure, at.tip_pressure);
  EXPECT_NEAR(told, after, 0.1 * after + 1e-10);  // fitted
  return after;
}

TEST(ThumbDose, KnowsWhatAHeldBarrelStillGivesWithAndWithoutAir) {
  EXPECT_GT(given_while_held(0, 4, 2e3), 10e-9);
  EXPECT_GT(given_while_held(0.2e-6, 4, 2e3), 40e-9);
  EXPECT_GT(given_while_held(0, 12, 2e3), 70e-9) << "it does not spring back";
  EXPECT_NEAR(after_flow(Syringe{}, 300e3, 200e3), 1e-7, 1e-12);
}

TEST(ThumbDose, HoldsThePlungerUntilTheBarrelHasRunOut) {
  PlungerParams params;
  ThumbDose dose(params, 1e-6);
  OperatorPhase push;
  dose.begin(0);
  EXPECT_EQ(dose.present(&push), &push);
  dose.step(true, 1e-6, 10e3, 0, 1e-7, kDoseDt);
  ASSERT_TRUE(dose.enough());
  int held = 0;
  for (; dose.present(&push) != nullptr; ++held) {
    ASSERT_TRUE(dose.present(&push)->thumb_holds);
    EXPECT_FALSE(dose.done());
    dose.step(false, 1e-6, 10e3, 0, 1e-7, kDoseDt);
  }
  EXPECT_TRUE(dose.done());
  EXPECT_NEAR(held * kDoseDt, run_out_time(params), 1.5 * kDoseDt);
  // 27 G of 50 mm: 1.05e12 Pa s/m^3 times 1e-12 m^3/Pa, five times.
  params.needle = *bore_of_gauge(27, 0.05);
  EXPECT_NEAR(run_out_time(params), 5.24, 0.01);
}

TEST(ThumbDose, LetsGoBeforeTheMarkAndStaysSoUntilTheNext) {
  const Syringe syringe;
  ThumbDose dose({}, 1e-6);
  dose.begin(2e-6);
  dose.step(true, 2.98e-6, 10e3, 0, 1e-7, kDoseDt);
  EXPECT_FALSE(dose.enough()) << "0.01 ml are still to come, 0.02 are missing";
  dose.step(true, 2.991e-6, 10e3, 0, 1e-7, kDoseDt);
  EXPECT_TRUE(dose.enough());
  dose.step(true, 2.0e-6, 0, 0, 1e-7, kDoseDt);
  EXPECT_TRUE(dose.enough());
  dose.begin(3e-6);
  EXPECT_FALSE(dose.enough());
  ARTUS_RUNS_REALTIME(ThumbDose::step, dose.step(true, 0, 0, 0, 0, kDoseDt));
  ARTUS_RUNS_REALTIME(ThumbDose::begin, dose.begin(0));
  ARTUS_RUNS_REALTIME(after_flow, test::use(after_flow(syringe, 1e3, 0)));
}

TEST(ThumbDose, GivesUpWhereNothingGoesInButNotWhileNobodyPushes) {
  ThumbDose dose({}, 1e-6);
  dose.begin(0);
  for (int k = 0; k < 20000; ++k) dose.step(false, 0, 0, 0, 0, kDoseDt);
  EXPECT_FALSE(dose.enough());
  for (int k = 0; k < 5900; ++k) dose.step(true, 0, 300e3, 0, 0, kDoseDt);
  EXPECT_FALSE(dose.enough()) << "what the barrel holds does not count where nothing flows";
  for (int k = 0; k < 200; ++k) dose.step(true, 0, 300e3, 0, 0, kDoseDt);
  EXPECT_TRUE(dose.enough());
}

}  // namespace
}  // namespace artus
