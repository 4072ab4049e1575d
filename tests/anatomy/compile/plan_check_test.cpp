// SPDX-License-Identifier: AGPL-3.0-or-later
// Poses and injections that cannot be used are found, and what the refusal offers mends them.
#include "artus/detail/anatomy/compile/check/plan_check.h"

#include <algorithm>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/compile/check/plan_ground.h"
#include "tests/anatomy/compile/balls_joint.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

using testing::HasSubstr;

constexpr double kSkin = 0.05;  // m, radius of the body
constexpr double kBone = 0.015;

/// A ball of fat with a bone in its middle and a needle pass that misses it.
class Plans : public testing::Test {
 protected:
  Plans() : joint_(kSkin, {{"core", "bone", Vec3::Zero(), kBone}}) {
    joint_.file.tissues = read_bundled_tissues().value();
    joint_.file.region_of_interest = RegionOfInterest{Vec3::Zero(), 0.055, {}};
    pass().entry = Vec3(0, -0.03, 0.04);
    pass().target = Vec3(0, -0.028, 0.01);
    pass().line = 12;
  }
  PlannedInjection& pass() {
    if (joint_.file.injections.empty()) joint_.file.injections.push_back({"first", {}, {}});
    return joint_.file.injections.front();
  }
  [[nodiscard]] std::vector<PlanProblem> problems() const {
    return find_plan_problems(joint_.file, make_ground(joint_.file, joint_.surfaces));
  }
  void follow(const PlanProblem& problem) {
    for (const PlanMend& mend : problem.mends) {
      if (mend.key == "entry") pass().entry = mend.value;
      if (mend.key == "target") pass().target = mend.value;
      if (mend.key == "centre") joint_.file.region_of_interest->centre = mend.value;
      if (mend.key == "radius") joint_.file.region_of_interest->radius = mend.value.x();
      if (mend.key == "half_extent") joint_.file.region_of_interest->half_extent = mend.value;
      if (mend.key == "position") joint_.file.X_JP_default->translation() = mend.value;
      if (mend.key == "direction")
        joint_.file.X_JP_default = make_pose(joint_.file.X_JP_default->translation(), mend.value,
                                             joint_.file.X_JP_default->linear().col(0));
    }
  }
  /// One problem that says `what`; following what each refusal offers leaves none.
  void expect_mended(const std::string& what) {
    const auto first = problems();
    ASSERT_FALSE(first.empty()) << what;
    EXPECT_THAT(to_line(first.front()), HasSubstr(what));
    for (int round = 0; round < 4 && !problems().empty(); ++round) {
      ASSERT_FALSE(problems().front().mends.empty()) << to_line(problems().front());
      follow(problems().front());
    }
    for (const PlanProblem& left : problems()) ADD_FAILURE() << to_line(left);
  }

  test::BallsJoint joint_;
};

TEST_F(Plans, ThatFitHaveNoProblem) {
  for (const PlanProblem& p : problems()) ADD_FAILURE() << to_line(p);
  pass().target = Vec3::Zero();
  EXPECT_TRUE(problems().empty()) << "the bone that holds the target is not in its way";
}

TEST_F(Plans, SayTheirLineAndAllThatIsWrongAtOnce) {
  joint_.file.X_JP_default = make_pose(Vec3(0, 0, 0.08), -Vec3::UnitZ(), Vec3::UnitX());
  joint_.file.probe_line = 7;
  pass().entry = Vec3(0, 0, 0.08);
  joint_.file.needle = PlannedInjection{"", Vec3(0, 0, 0.05), Vec3(0, 0, -0.03), 9};
  const auto found = problems();
  ASSERT_EQ(found.size(), 3U);
  EXPECT_THAT(to_line(found[0]), HasSubstr("[probe] (line 7): its position lies 30.0 mm off"));
  EXPECT_THAT(to_line(found[1]),
              HasSubstr("[needle] (line 9): bone 'core' is in the needle's path"));
  EXPECT_THAT(to_line(found[2]), HasSubstr("injection 'first' (line 12): its entry lies"));
}

TEST_F(Plans, WithAnEntryOffTheSkinOrUnderItAreMended) {
  pass().entry = Vec3(0, -0.031, 0.043);
  expect_mended("mm off the skin");
  pass().entry = Vec3(0, -0.028, 0.03);
  expect_mended("mm under the skin");
}

TEST_F(Plans, WithBoneInTheWayAreMended) {
  pass().entry = Vec3(0, 0, kSkin);
  pass().target = Vec3(0, 0, -0.03);
  const auto found = problems();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].message, HasSubstr("35.0 mm after the entry and 45.0 mm before the target"));
  expect_mended("bone 'core' is in the needle's path");
}

TEST_F(Plans, OutsideTheBodyOrTheRegionAreMended) {
  pass().target = Vec3(0, -0.07, 0);
  expect_mended("20.0 mm outside of the skin");
  joint_.file.region_of_interest->radius = 0.03;
  joint_.file.region_of_interest->centre = Vec3(0, -0.028, 0.02);
  pass().entry = Vec3(0, 0.03, 0.04);
  pass().target = Vec3(0, -0.028, 0.02);
  expect_mended("outside of the region of interest");
}

TEST_F(Plans, LongerThanTheLongestNeedleAreMended) {
  pass().entry = Vec3(0, -0.045, 0.0218);
  pass().target = Vec3(0, 0.0445, 0.02);
  expect_mended("longest needle");
}

TEST_F(Plans, InARegionWithoutSkinAreMended) {
  for (const bool box : {false, true}) {
    joint_.file.region_of_interest = RegionOfInterest{Vec3(0, -0.02, 0.01), 0.01, {}};
    if (box) {
      joint_.file.region_of_interest->radius = 0;
      joint_.file.region_of_interest->half_extent = Vec3(0.01, 0.01, 0.01);
    }
    expect_mended("holds no skin");
  }
}

TEST_F(Plans, InARegionThatIsWideEnoughButOffTheSkinAreMendedByItsPlace) {
  joint_.file.region_of_interest = RegionOfInterest{Vec3(0, 0, 0.2), 0.04, {}};
  const auto found = problems();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].message, HasSubstr("move it: centre = (0.0, 0.0, 50.0) mm"));
  expect_mended("holds no skin");
}

TEST_F(Plans, WithAWayTooShortToBeMeantAreMended) {
  pass().target = pass().entry + Vec3(0, 0, -0.1e-3);
  const auto found = problems();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].message, HasSubstr("only 0.1 mm apart, too short for a needle"));
  expect_mended("too short");
}

TEST_F(Plans, WithAProbeThatDoesNotStandAreMended) {
  const Vec3 top(0, 0, kSkin);
  joint_.file.X_JP_default = make_pose(top, -Vec3::UnitZ(), Vec3::UnitX());
  EXPECT_TRUE(problems().empty());
  joint_.file.X_JP_default = make_pose(Vec3(0, 0, 0.06), -Vec3::UnitZ(), Vec3::UnitX());
  expect_mended("10.0 mm off the skin");
  joint_.file.X_JP_default = make_pose(top, Vec3::UnitZ(), Vec3::UnitX());
  expect_mended("away from the body");
  joint_.file.X_JP_default = make_pose(top, -Vec3::UnitZ(), Vec3::UnitX());
  joint_.file.region_of_interest = RegionOfInterest{Vec3(0, -0.025, 0.025), 0.037, {}};
  expect_mended("over its whole length");
}

TEST(CompiledPlans, AreJudgedAsThoseOfTheSurfaces) {
  const CompiledJoint body = test::make_nested_spheres(
      std::vector<SphereLayer>{{"muscle", 0.05}, {"fat", 0.03}, {"bone", 0.015}});
  const PlanGround ground = make_ground(body, std::nullopt);
  EXPECT_NEAR(ground.skin_distance(Vec3(0, 0, 0.02)), -0.03, 0.5e-3);
  EXPECT_NEAR(ground.skin_distance(Vec3(0, 0, 0.07)), 0.02, 0.5e-3);
  const auto layers = ground.layers({Vec3(0, 0.001, 0.06), Vec3(0, 0.001, 0)});
  ASSERT_EQ(layers.size(), 4U);
  EXPECT_EQ(layers[0].name, "outside");
  EXPECT_EQ(layers[1].tissue, "muscle");
  EXPECT_NEAR(layers[2].entry, 0.03, 0.5e-3);
  EXPECT_TRUE(layers[3].hard);
  JointFile file;
  file.injections = {{"through", Vec3(0, 0, 0.05), Vec3(0, 0, -0.02)},
                     {"free", Vec3(0, -0.02, 0.0458), Vec3(0, -0.02, 0.01)}};
  const auto problems = find_plan_problems(file, ground);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0].message, HasSubstr("is in the needle's path"));
  ASSERT_EQ(problems[0].mends.size(), 1U);
  file.injections[0].entry = problems[0].mends[0].value;
  EXPECT_TRUE(find_plan_problems(file, ground).empty());
}

}  // namespace
}  // namespace artus
