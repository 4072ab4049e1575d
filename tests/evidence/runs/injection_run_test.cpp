// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_run.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "artus/detail/evidence/runs/injection_plan.h"
#include "artus/detail/evidence/runs/injection_report.h"
#include "artus/session/recording.h"
#include "artus/session/replay.h"
#include "tests/support/layered_body.h"
#include "tests/support/meshed_block.h"

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
  return spec;
}

TEST(InjectionPlan, ABursaOnTheLineIsMeantAndHasTheBevelInIt) {
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 1e-6);
  spec.into.reset();
  const auto plan = plan_line(*scene, spec);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->region, test::region_named(scene->joint(), "bursa"));
  EXPECT_NEAR(plan->layer.from, 14e-3, 1e-9);
  EXPECT_NEAR(plan->layer.to, 16e-3, 1e-9);
  EXPECT_NEAR(stop_in(*plan, plan->layer, 1e-3), 15.5e-3, 1e-9);
  EXPECT_NEAR(stop_in(*plan, {13e-3, 20e-3}, 1e-3), 17e-3, 1e-9) << "where it is open";
  spec.press = -1;
  EXPECT_FALSE(plan_line(*scene, spec));
}

/// A line into one side of a shell, and out of the other.
TEST(InjectionPlan, TheStretchThatTheTargetIsInIsMeant) {
  const std::vector<SphereLayer> spheres{{"muscle", 40e-3}, {"bursa", 20e-3}, {"tendon", 18e-3}};
  const Scene scene(std::make_shared<const CompiledJoint>(test::make_nested_spheres(spheres)));
  InjectionSpec spec;
  spec.entry = Vec3(0, 0, -40e-3);
  spec.volume = 1e-6;
  spec.rate = 0.2e-6;
  for (const double z : {-19e-3, 19e-3}) {
    spec.target = Vec3(0, 0, z);
    const auto plan = plan_line(scene, spec);
    ASSERT_TRUE(plan);
    EXPECT_NEAR(plan->layer.from, 40e-3 + z - 1e-3, 0.3e-3);
    EXPECT_NEAR(plan->layer.to, 40e-3 + z + 1e-3, 0.3e-3);
  }
}

Scene bursa_at(const Vec3& centre) {
  return Scene(std::make_shared<const CompiledJoint>(test::make_block_with_sphere(
      {"fat", Vec3(0.1, 0.1, 0.05), Vec3::Zero(), "bursa", centre, 2e-3, 4})));
}

TEST(InjectionPlan, ABursaThatIsPressedOffTheLineIsAimedAtAgain) {
  const Scene rest = bursa_at({0, 0, 8e-3});
  InjectionSpec spec;
  spec.entry = Vec3(-20e-3, 0, 0);
  spec.target = Vec3(0, 0, 8e-3);
  spec.volume = 1e-6;
  spec.rate = 0.2e-6;
  const auto plan = plan_line(rest, spec);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan_again(rest, spec.entry, Vec3::UnitY(), *plan).direction, plan->direction);
  const Scene beside = bursa_at({0, 0, 8.5e-3});
  EXPECT_EQ(plan_again(beside, spec.entry, Vec3::UnitY(), *plan).direction, plan->direction)
      << "the line still meets it well";
  for (const double z : {10.5e-3, 5.5e-3}) {
    const Vec3 centre(0, 0, z);
    const LinePlan again = plan_again(bursa_at(centre), spec.entry, Vec3::UnitY(), *plan);
    const Vec3 to_centre = centre - spec.entry;
    EXPECT_LT(again.direction.cross(to_centre).norm(), 0.6e-3) << "through the middle";
    EXPECT_NEAR((again.layer.from + again.layer.to) / 2, to_centre.norm(), 0.2e-3);
    EXPECT_NEAR(stop_in(again, again.layer, 1e-3), to_centre.norm(), 0.7e-3);
  }
  const Scene away = bursa_at({0, 0, 40e-3});
  EXPECT_EQ(plan_again(away, spec.entry, Vec3::UnitY(), *plan).direction, plan->direction);
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
  const Syringe& syringe = tendon->plunger.syringe;
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
  spec.syringe.barrel = 8.4e-6;
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  ASSERT_GT(run->plunger.syringe.break_loose, 3.5);
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
  spec.syringe.filled = 15.5e-6;
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
  spec.syringe.barrel = spec.syringe.filled = 20e-6;
  spec.rate = 0.5e-6;
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_GT(run->highest_pressure * run->plunger.syringe.area(), run->plunger.syringe.break_loose);
  EXPECT_NEAR(run->given / spec.volume, 1, 0.003);
}

TEST(InjectionRun, AThinNeedleIsWaitedForUntilTheBarrelHasGivenWhatItHolds) {
  // Some 200 kPa, 0.2 ml in the barrel, out within a second's time constant.
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 1e-6);
  spec.syringe.gauge = 27;
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
      spec.syringe.filled = 2e-6;
      spec.syringe.liquid = liquid;
      spec.syringe.gauge = gauge;
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
  spec.syringe.gauge = 18;
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
  spec.syringe.barrel = 50e-6;
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
  spec.syringe.filled = 46e-6;
  spec.rate = 1e-6;
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_NE(run->status & PlungerStatus::kRuptured, 0U) << run->given << " m^3 given";
  EXPECT_LE(run->highest_force, run->plunger.max_force);
  EXPECT_LT(std::abs(run->unbalanced), 1e-15);
  EXPECT_LT(run->volumes.front(), 0.95 * run->given);
  EXPECT_FALSE(all_hold(claims_of(*run)));
}

TEST(InjectionRun, GrainsThatSettleInAThinNeedleStopTheHand) {
  const auto scene = shoulder_like();
  InjectionSpec spec = spec_into(*scene, "bursa", 1e-6);
  spec.syringe.liquid = "steroid";
  spec.syringe.gauge = 27;
  spec.aspirate = 60;  // s; grains clog after 20 in the mean
  const auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run);
  EXPECT_NE(run->status & PlungerStatus::kClogged, 0U);
  EXPECT_FALSE(run->complete);
  EXPECT_FALSE(all_hold(claims_of(*run)));
  EXPECT_LE(run->highest_force, run->plunger.max_force);
  EXPECT_LT(std::abs(run->unbalanced), 1e-15);
}

/// Skin, muscle, a bursa from 14 mm on, tendon, bone, as tetrahedra.
std::shared_ptr<const Scene> soft_shoulder() {
  const std::vector<FlatLayer> layers{
      {"skin", 2e-3}, {"muscle", 12e-3}, {"bursa", 5e-3}, {"tendon", 6e-3}, {"bone", 12e-3}};
  static const auto kScene = std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_meshed_block(layers, .12, .08, 4e-3)));
  return kScene;
}

InjectionSpec spec_in_tissue() {
  InjectionSpec spec = spec_into(*soft_shoulder(), "bursa", 0.5e-6);
  spec.entry = Vec3(-26e-3, 0, 0);
  spec.target = Vec3(-12e-3, 0, 16e-3);
  return spec;
}

TEST(InjectionRun, InTissueThatGivesWayTheBursaIsMetByThePictureAndTakesWhatIsMeant) {
  const auto soft = run_injection(*soft_shoulder(), spec_in_tissue());
  ASSERT_TRUE(soft) << soft.error().message;
  EXPECT_TRUE(soft->gave_way);
  for (const Claim& claim : claims_of(*soft)) EXPECT_TRUE(claim.pass) << to_line(claim);
  InjectionSpec spec = spec_in_tissue();
  spec.rigid = true;
  const auto rigid = run_injection(*soft_shoulder(), spec);
  ASSERT_TRUE(rigid) << rigid.error().message;
  EXPECT_FALSE(rigid->gave_way);
  for (const Claim& claim : claims_of(*rigid)) EXPECT_TRUE(claim.pass) << to_line(claim);
  // Where the tip comes into muscle, at 2.7 mm, the tissue still tents before it.
  const auto deep_at = [](const InjectionRun& run, double since_skin) {
    const auto skin = std::find_if(run.rows.begin(), run.rows.end(),
                                   [](const InjectionRow& row) { return row.region != kOutside; });
    return row_of(run, skin->time + since_skin).depth;
  };
  EXPECT_LT(deep_at(*soft, 0.3), deep_at(*rigid, 0.3));
}

TEST(InjectionRun, IsASessionThatReplaysToTheSameBytes) {
  Recording recording;
  const auto run = run_injection(*soft_shoulder(), spec_in_tissue(), &recording);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(recording.ticks.size(), run->rows.size());
  EXPECT_GT(recording.packets.size(), 50U);
  const auto replayed = replay(recording, soft_shoulder());
  ASSERT_TRUE(replayed) << replayed.error().message;
  EXPECT_TRUE(replayed->identical())
      << replayed->different_ticks << ' ' << replayed->different_frames;
  EXPECT_EQ(replayed->frames, recording.frames.size());
  const TickRecord& last = recording.ticks.back();
  EXPECT_NEAR(last.plunger.given, run->given, 1e-12);
}

}  // namespace
}  // namespace artus
