// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_run.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "artus/detail/evidence/runs/injection_report.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

/// Skin, fat, muscle, a bursa of 2 mm from 14 mm on, tendon, bone.
std::shared_ptr<const Scene> shoulder_like() {
  const std::vector<FlatLayer> layers{{"skin", 2e-3},  {"fat", 4e-3},    {"muscle", 8e-3},
                                      {"bursa", 2e-3}, {"tendon", 8e-3}, {"bone", 20e-3}};
  return std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 0.2, 0.2)));
}

InjectionSpec spec_into(const Scene& scene, const char* region, double volume) {
  InjectionSpec spec;
  spec.entry = Vec3::Zero();
  spec.target = Vec3(0, 0, 30e-3);
  spec.into = test::region_named(scene.joint(), region);
  spec.volume = volume;
  spec.rate = 0.2e-6;
  spec.plunger.liquids = *read_bundled_liquids();
  spec.plunger.liquid = *find_liquid(spec.plunger.liquids, "saline");
  return spec;
}

TEST(InjectionRun, ATendonTakesAHandsForceAndABursaDoesNot) {
  const auto scene = shoulder_like();
  const auto bursa = run_injection(*scene, spec_into(*scene, "bursa", 0.5e-6));
  const auto tendon = run_injection(*scene, spec_into(*scene, "tendon", 0.5e-6));
  ASSERT_TRUE(bursa && tendon);
  EXPECT_EQ(bursa->target, "bursa");
  EXPECT_LT(std::abs(bursa->unbalanced), 1e-15);
  EXPECT_LT(bursa->highest_force, tendon->highest_force);
  // What the tendon's pressure holds in the barrel springs back before the needle is drawn out, but
  // for what the stopper's friction keeps.
  const Syringe& syringe = tendon->spec.plunger.syringe;
  EXPECT_GT(tendon->given, 0.98 * 0.5e-6);
  EXPECT_LT(tendon->given, 0.5e-6 + syringe.softness() * syringe.break_loose / syringe.area());
}

TEST(InjectionRun, ABursaAsThinAsTheBevelIsLongTakesWhatIsMeantForIt) {
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 1e-6);
  spec.rate = 0.1e-6;
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_GE(run->volumes.front(), 0.95 * run->given);
  EXPECT_NEAR(run->given, 1e-6, 0.05e-6);
}

TEST(InjectionRun, ComingBackUnderGentlePressureFlowsWhenTheBevelIsInTheBursa) {
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 1e-6);
  spec.technique = Technique::through_and_back;
  spec.rate = 0.1e-6;
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_GE(run->volumes.front(), 0.95 * run->given);
  double deepest = 0;
  for (const InjectionRow& row : run->rows) deepest = std::max(deepest, row.depth);
  EXPECT_GT(deepest, 16e-3);  // through the floor
  const auto flowing = std::find_if(run->rows.begin(), run->rows.end(),
                                    [](const InjectionRow& row) { return row.phase == "inject"; });
  ASSERT_NE(flowing, run->rows.end());
  EXPECT_LT(flowing->depth, deepest);
  EXPECT_GT(flowing->depth, 14e-3);
}

TEST(InjectionRun, ComingBackWithAWideBarrelMovesItsStopper) {
  // Of 10 ml the stopper breaks loose at more than the 3.5 N that move one of 5 ml.
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 1e-6);
  spec.technique = Technique::through_and_back;
  spec.plunger.syringe = syringe_for(8.4e-6);
  ASSERT_GT(spec.plunger.syringe.break_loose, 3.5);
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_GE(run->volumes.front(), 0.95 * run->given);
}

TEST(InjectionRun, ATargetInTheAirIsRefused) {
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 1e-6);
  spec.into.reset();
  spec.entry -= 0.2 * (spec.target - spec.entry).normalized();
  spec.target = spec.entry + 0.01 * (spec.target - spec.entry).normalized();
  const auto run = run_injection(*scene, spec);
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, ErrorCode::invalid);
}

TEST(InjectionRun, ASlowRateOnAWideBarrelGivesWhatIsMeantForIt) {
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 15e-6);
  spec.plunger.syringe = syringe_for(15.5e-6);
  spec.plunger.syringe.filled = 15.5e-6;
  spec.rate = 0.1e-6;
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run->complete);
  EXPECT_NEAR(run->given, 15e-6, 0.3e-6);
}

TEST(InjectionRun, ATenseBursaDoesNotPushBackWhatWasGiven) {
  // 18.8 kPa on a barrel of 20 ml are more than the stopper's friction.
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 12e-6);
  spec.plunger.syringe = syringe_for(20e-6);
  spec.rate = 0.5e-6;
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_GT(run->highest_pressure * spec.plunger.syringe.area(), spec.plunger.syringe.break_loose);
  EXPECT_NEAR(run->given / spec.volume, 1, 0.003);
}

TEST(InjectionRun, AThinNeedleIsWaitedForUntilTheBarrelHasGivenWhatItHolds) {
  // Some 200 kPa, 0.2 ml in the barrel, out within a second's time constant.
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 1e-6);
  spec.plunger.needle = *bore_of_gauge(27, 0.05);
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_NEAR(run->given / spec.volume, 1, 0.01);
  EXPECT_GE(run->volumes.front(), 0.97 * run->given);
}

TEST(InjectionRun, AThickLiquidIsGivenInFullThoughABarrelKeepsSomeOfIt) {
  const auto scene = shoulder_like();
  for (const char* liquid : {"hyaluronic_light", "hyaluronic", "hyaluronic_crosslinked"})
    for (const int gauge : {18, 22, 25}) {
      InjectionSpec spec = spec_into(*scene, "bursa", 1e-6);
      spec.rate = 0.1e-6;
      spec.plunger.syringe = syringe_for(2e-6);
      spec.plunger.liquid = *find_liquid(spec.plunger.liquids, liquid);
      spec.plunger.needle = *bore_of_gauge(gauge, 0.05);
      const auto run = run_injection(*scene, spec);
      ASSERT_TRUE(run);
      EXPECT_NEAR(run->given / spec.volume, 1, 0.01) << liquid << ' ' << gauge;
    }
}

TEST(InjectionRun, AWideNeedlesWholeOpeningGoesIntoTheSpaceThatThePlanIsIn) {
  const std::vector<FlatLayer> layers{
      {"skin", 2e-3}, {"fat", 8e-3}, {"bursa", 5e-3}, {"bone", 20e-3}};
  const Scene scene(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 0.2, 0.2)));
  InjectionSpec spec = spec_into(scene, "bursa", 1e-6);
  spec.into.reset();
  spec.target = Vec3(0, 0, 11e-3);  // 1 mm of 3.2 mm of opening
  spec.plunger.needle = *bore_of_gauge(18, 0.05);
  const auto run = run_injection(scene, spec);
  ASSERT_TRUE(run);
  EXPECT_EQ(run->target, "bursa");
  EXPECT_GE(run->volumes.front(), 0.99 * run->given);
}

TEST(InjectionRun, ARateThatTheThumbCannotKeepIsTold) {
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 4e-6);
  spec.rate = 0.1e-6;
  const auto kept = run_injection(*scene, spec);
  ASSERT_TRUE(kept);
  EXPECT_NEAR(mean_flow(*kept), 0.1e-6, 0.01e-6);
  EXPECT_TRUE(notes_of(*kept).empty()) << notes_of(*kept).front();
  spec.volume = 0.02e-6;
  const auto tiny = run_injection(*scene, spec);
  ASSERT_TRUE(tiny);
  ASSERT_EQ(notes_of(*tiny).size(), 1U);
  EXPECT_EQ(notes_of(*tiny).front(), "0.02 ml are out before the flow comes to 0.1 ml/s");
  spec.volume = 4e-6;
  spec.plunger.syringe = syringe_for(50e-6);
  spec.plunger.syringe.filled = 5e-6;
  spec.rate = 2e-6;
  const auto slow = run_injection(*scene, spec);
  ASSERT_TRUE(slow);
  EXPECT_LT(mean_flow(*slow), 1.6e-6);
  ASSERT_FALSE(notes_of(*slow).empty());
  EXPECT_NE(notes_of(*slow).front().find("rate was not kept"), std::string::npos);
}

TEST(InjectionRun, IsTheSameTwice) {
  const auto scene = shoulder_like();
  const InjectionSpec spec = spec_into(*scene, "muscle", 0.2e-6);
  const auto a = run_injection(*scene, spec);
  const auto b = run_injection(*scene, spec);
  ASSERT_EQ(a->rows.size(), b->rows.size());
  EXPECT_EQ(a->rows.back().plunger.travel, b->rows.back().plunger.travel);
  EXPECT_EQ(summarize(*a).dump(), summarize(*b).dump());
}

TEST(InjectionRun, RefusesALineThatMissesAndAVolumeThatIsNone) {
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bone", 1e-6);
  spec.target = Vec3(0, 0.03, 0.01);
  spec.entry = Vec3(0, 0, 0.005);
  spec.into = test::region_named(scene->joint(), "bursa");
  spec.target = spec.entry + Vec3(0.01, 0, 0);
  EXPECT_FALSE(run_injection(*scene, spec));
  InjectionSpec none = spec_into(*scene, "bursa", 0);
  EXPECT_THAT(run_injection(*scene, none).error().message, testing::HasSubstr("volume"));
}

TEST(InjectionRun, MoreThanABursaHoldsTearsItAndIsFoundAroundIt) {
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 45e-6);
  spec.plunger.syringe = syringe_for(46e-6);
  spec.rate = 1e-6;
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_NE(run->status & PlungerStatus::kRuptured, 0U) << run->given << " m^3 given";
  EXPECT_LE(run->highest_force, spec.plunger.max_force);
  EXPECT_LT(std::abs(run->unbalanced), 1e-15);
  EXPECT_LT(run->volumes.front(), 0.95 * run->given);
  EXPECT_FALSE(all_hold(claims_of(*run)));
}

TEST(InjectionRun, GrainsThatSettleInAThinNeedleStopTheHand) {
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 1e-6);
  spec.plunger.liquid = *find_liquid(spec.plunger.liquids, "steroid");
  spec.plunger.needle = *bore_of_gauge(27, 0.05);
  spec.plunger.clog_time = 0.5;  // s; in the mean 20, here soon
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_NE(run->status & PlungerStatus::kClogged, 0U);
  EXPECT_FALSE(run->complete);
  EXPECT_FALSE(all_hold(claims_of(*run)));
  EXPECT_LE(run->highest_force, spec.plunger.max_force);
  EXPECT_LT(std::abs(run->unbalanced), 1e-15);
}

}  // namespace
}  // namespace artus
