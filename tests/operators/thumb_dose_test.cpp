// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/thumb_dose.h"

#include <gtest/gtest.h>

#include "tests/support/real_time.h"

namespace artus {
namespace {

constexpr double kDoseDt = 1e-3;  // s

/// What a real plunger gives in 5 s while the thumb holds it, m^3, into a place of one pressure;
/// before, it pressed for `pushed` s.
double given_while_held(const PlungerParams& params, double push, double place, double pushed = 3) {
  constexpr double kHeld = 5;  // s
  Space space;
  space.name = space.like = "place";
  space.law.rest = place;
  Plunger plunger(params, {space}, kDoseDt);
  PlungerInput input;
  input.tip[0] = {0, 1};
  input.force = push;
  for (int k = 0; k < static_cast<int>(pushed / kDoseDt); ++k) plunger.step(input);
  const PlungerState at = plunger.state();
  const double before = plunger.states()[0].volume;
  for (int k = 0; k < static_cast<int>(kHeld / kDoseDt); ++k) {
    input.force = params.syringe.area() * plunger.state().pressure;
    plunger.step(input);
  }
  const double after = plunger.states()[0].volume - before;
  const double told =
      HeldBarrel(params, kHeld).gives(at.pressure - at.tip_pressure, at.tip_pressure);
  // Where the barrel's compliance is most of what is given, the stopper rests from the first tick.
  EXPECT_NEAR(told, after, 0.01 * after + 1e-11) << params.liquid.name << ' ' << push;
  return after;
}

TEST(ThumbDose, KnowsWhatAHeldBarrelStillGivesWithAndWithoutAir) {
  PlungerParams params;
  params.liquid.density = 1000;
  EXPECT_GT(given_while_held(params, 4, 2e3), 10e-9);
  EXPECT_GT(given_while_held(params, 12, 2e3), 70e-9) << "it does not spring back";
  params.syringe.air = 0.2e-6;
  EXPECT_GT(given_while_held(params, 4, 2e3), 40e-9);
}

TEST(ThumbDose, KnowsThatALiquidThatThinsHardlyRunsOutAtTheEnd) {
  PlungerParams params;
  params.liquids = *read_bundled_liquids();
  for (const char* name : {"hyaluronic_light", "hyaluronic", "hyaluronic_crosslinked"}) {
    params.liquid = *find_liquid(params.liquids, name);
    for (const int gauge : {18, 22, 25}) {
      params.needle = *bore_of_gauge(gauge, 0.05);
      const double after = given_while_held(params, 30, 2e3);
      EXPECT_LT(after, params.syringe.softness() * 28 / params.syringe.area()) << name << gauge;
    }
  }
  // All but nothing of 245 kPa is left of water, a tenth and more of the thickest.
  const double all = params.syringe.softness() * 245e3;
  EXPECT_LT(HeldBarrel(params, 10).gives(245e3), 0.9 * all);
  params.liquid = *find_liquid(params.liquids, "saline");
  params.needle = *bore_of_gauge(22, 0.05);
  EXPECT_GT(HeldBarrel(params, 10).gives(245e3), 0.999 * all);
  EXPECT_EQ(HeldBarrel(params, 10).gives(-1), 0);
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
  const HeldBarrel barrel({}, 1.5);
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
  ARTUS_RUNS_REALTIME(HeldBarrel::gives, test::use(barrel.gives(1e3)));
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
