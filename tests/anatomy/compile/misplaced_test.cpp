// SPDX-License-Identifier: AGPL-3.0-or-later
// Structures that are not where they should be, with the numbers.
#include "artus/detail/anatomy/compile/check/misplaced.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "tests/anatomy/compile/balls_joint.h"
#include "tests/anatomy/compile/joint_folder.h"

namespace artus {
namespace {

using test::Ball;
using test::BallsJoint;
using testing::HasSubstr;

std::vector<Finding> misplaced(const std::vector<Ball>& balls) {
  BallsJoint joint(0.05, balls);
  joint.file.tissues = read_bundled_tissues().value();
  return find_misplaced(joint.file, joint.surfaces);
}

const Ball kBone{"femur", "bone", Vec3(0, 0, 0), 0.02};
const Ball kMuscle{"vastus", "muscle", Vec3(0, 0.03, 0), 0.012};

TEST(Misplaced, NothingIsSaidOfWhatLiesWell) {
  EXPECT_TRUE(misplaced({kBone, kMuscle}).empty());
}

TEST(Misplaced, ABodyOfAnotherFrameIsRefusedWithTheWayBetween) {
  const Vec3 away(0.3, 0, 0);
  Ball bone = kBone;
  Ball muscle = kMuscle;
  bone.centre += away;
  muscle.centre += away;
  const auto found = misplaced({bone, muscle});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].verdict, Verdict::refused);
  EXPECT_EQ(found[0].what, "body");
  EXPECT_THAT(found[0].message, HasSubstr("2 of 2 structures lie outside of it"));
  EXPECT_THAT(found[0].message, HasSubstr("(300, "));
}

TEST(Misplaced, WhatSticksOutOfTheSkinIsToldWithShareAndDistance) {
  Ball out = kMuscle;
  out.centre = Vec3(0, 0.047, 0);
  const auto found = misplaced({kBone, out});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].verdict, Verdict::look);
  EXPECT_THAT(found[0].message, testing::ContainsRegex("up to [89]\\."));
  // Of a sphere near the skin's edge: about where cos > (50.5^2 - 47^2 - 12^2) / (2 * 47 * 12).
  EXPECT_THAT(found[0].message, testing::ContainsRegex("4[12] % of its surface lies outside"));
  out.centre = Vec3(0, 0.09, 0);
  const auto lost = misplaced({kBone, kMuscle, out});
  EXPECT_THAT(lost.at(0).message, HasSubstr("100 % of its surface lies outside"));
  EXPECT_EQ(lost.at(0).verdict, Verdict::refused) << "none of it is in the joint";
}

TEST(Misplaced, WhatLiesAllInABoneIsToldWithItsDepth) {
  const auto found = misplaced({kBone, {"nerve", "nerve", Vec3(0, 0, 0), 0.005}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].message, HasSubstr("inside the bone 'femur', 15."));
  EXPECT_THAT(found[0].message, HasSubstr("takes all of it"));
}

TEST(Misplaced, WhatAnEarlierStructureTakesWholeIsToldAndTheOtherOrderMendsIt) {
  const Ball nerve{"nerve", "nerve", Vec3(0, 0.03, 0), 0.003};
  const auto found = misplaced({kBone, kMuscle, nerve});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what, "nerve");
  EXPECT_EQ(found[0].verdict, Verdict::refused) << "nothing of it would be in the joint";
  EXPECT_THAT(found[0].message, HasSubstr("put it before 'vastus'"));
  EXPECT_TRUE(misplaced({kBone, nerve, kMuscle}).empty());
}

TEST(Misplaced, WhatSeveralTakeTogetherIsToldWithTheirNames) {
  const Ball other{"rectus", "muscle", Vec3(0, 0.036, 0), 0.012};
  const Ball nerve{"nerve", "nerve", Vec3(0, 0.033, 0), 0.010};
  const auto found = misplaced({kBone, kMuscle, other, nerve});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what, "nerve");
  EXPECT_EQ(found[0].verdict, Verdict::refused);
  EXPECT_THAT(found[0].message, HasSubstr("'vastus', 'rectus'"));
}

TEST(Misplaced, OfWhichLessThanAQuarterOfTheSurfaceIsLeftIsRefusedAndALayerAroundOthersIsNot) {
  const Ball deep{"nerve", "nerve", Vec3(0, 0.0385, 0), 0.004};
  const auto found = misplaced({kBone, kMuscle, deep});
  ASSERT_EQ(found.size(), 1U) << "all but a cap of it lies in the muscle";
  EXPECT_EQ(found[0].kind, "lost");
  EXPECT_EQ(found[0].verdict, Verdict::refused);
  EXPECT_THAT(found[0].message, HasSubstr("too little of it would be in the joint"));
  EXPECT_TRUE(misplaced({kBone, kMuscle, {"nerve", "nerve", Vec3(0, 0.043, 0), 0.004}}).empty());
  EXPECT_TRUE(misplaced({kBone, {"coat", "cartilage", Vec3(0, 0, 0), 0.0203}}).empty())
      << "bone takes 96 % of its volume and nothing of its surface";
}

TEST(Misplaced, MoreThanHalfOutsideOfTheSkinIsRefusedUnlessThatLiesOutsideOfTheRegion) {
  BallsJoint joint(0.05, {kBone, {"leg", "muscle", Vec3(0, 0.053, 0), 0.01}});
  joint.file.tissues = read_bundled_tissues().value();
  auto found = find_misplaced(joint.file, joint.surfaces);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].verdict, Verdict::refused);
  EXPECT_THAT(found[0].message, HasSubstr("set 'region_of_interest' to where it does"));
  joint.file.region_of_interest.emplace();
  joint.file.region_of_interest->radius = 0.05;
  EXPECT_TRUE(find_misplaced(joint.file, joint.surfaces).empty());
}

TEST(Misplaced, WhatLiesFarFromTheRegionOfInterestIsRefused) {
  BallsJoint joint(0.08, {kBone, {"far", "muscle", Vec3(0, 0.06, 0), 0.01}});
  joint.file.tissues = read_bundled_tissues().value();
  joint.file.region_of_interest.emplace();
  joint.file.region_of_interest->radius = 0.025;
  const auto found = find_misplaced(joint.file, joint.surfaces);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what, "far");
  EXPECT_EQ(found[0].verdict, Verdict::refused) << "none of it is in the joint";
  EXPECT_THAT(found[0].message, HasSubstr("outside of the region of interest, by 25.0 mm"));
  joint.file.variants = {{"close", "a closer look", true, true}};
  EXPECT_TRUE(find_misplaced(joint.file, joint.surfaces).empty()) << "a variant cuts it on purpose";
  joint.file.variants.clear();
  joint.file.region_of_interest->radius = 0.055;
  EXPECT_TRUE(find_misplaced(joint.file, joint.surfaces).empty());
}

TEST(Misplaced, LandmarksInMetresOrFarAwayAreTold) {
  BallsJoint joint(0.05, {kBone, kMuscle});
  joint.file.tissues = read_bundled_tissues().value();
  joint.file.landmarks = {{"tip", Vec3(0, 0, 0.04)}, {"edge", Vec3(0.03, 0, 0)}};
  EXPECT_TRUE(find_misplaced(joint.file, joint.surfaces).empty());
  for (Landmark& landmark : joint.file.landmarks) landmark.position *= kMillimetre;
  auto found = find_misplaced(joint.file, joint.surfaces);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].message, HasSubstr("they are in metres"));
  joint.file.landmarks[0].position = Vec3(0, 0, 0.4);
  joint.file.landmarks[1].position = Vec3(0.03, 0, 0);
  found = find_misplaced(joint.file, joint.surfaces);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what, "landmarks");
  EXPECT_THAT(found[0].message, HasSubstr("1 of 2 lie more than 20 mm outside"));
}

TEST(Misplaced, TheSameSurfaceTwiceIsTold) {
  Ball twin = kMuscle;
  twin.name = "rectus";
  const auto found = misplaced({kBone, kMuscle, twin});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what, "rectus");
  EXPECT_THAT(found[0].message, HasSubstr("the same surface as 'vastus'"));
}

// A right leg in LPS: lateral is -x, anterior -y.
std::vector<Finding> mirrored(const char* side, const char* axes) {
  BallsJoint joint(0.05, {{"tibia", "bone", Vec3(0.01, 0, 0), 0.01},
                          {"fibula", "bone", Vec3(-0.02, 0.01, 0), 0.005},
                          {"medial_meniscus", "labrum", Vec3(0.02, 0, 0.02), 0.004},
                          {"lateral_meniscus", "labrum", Vec3(-0.02, 0, 0.02), 0.004},
                          {"patella", "bone", Vec3(0, -0.03, 0.02), 0.006}});
  joint.file.side = side;
  joint.file.axes = axes;
  return find_mirrored(joint.file, joint.surfaces);
}

TEST(Mirrored, ARightLegInItsOwnFrameIsNotDoubted) {
  EXPECT_TRUE(mirrored("right", "LPS").empty());
  EXPECT_TRUE(mirrored("none", "LPS").empty());
}

TEST(Mirrored, AWrongSideAndWrongAxesAreNoticed) {
  const auto side = mirrored("left", "LPS");
  ASSERT_EQ(side.size(), 1U);
  EXPECT_EQ(side[0].verdict, Verdict::look);
  EXPECT_THAT(side[0].message, HasSubstr("'fibula' lies medial of 'tibia'"));
  EXPECT_THAT(side[0].message, HasSubstr("side = \"left\""));
  const auto axes = mirrored("right", "RAS");  // x and y are the other way round
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_THAT(axes[1].message, HasSubstr("'patella' lies posterior of 'tibia'"));
}

TEST(ForeignFrames, AHeaderThatContradictsTheJointIsRefusedWithBoth) {
  const test::JointFolder folder("frames");
  folder.add_sphere("body", Vec3::Zero(), 30);
  for (const char* space : {"RAS", "LPS", "none"}) {
    const auto file = folder.path() / (std::string(space) + ".stl");
    ASSERT_TRUE(write_surface(make_sphere(Vec3::Zero(), 0.01), file, 1e-3));
    std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
    out << "3D Slicer output. SPACE=" << space;
  }
  folder.write_toml(
      "[[structure]]\nname = \"a\"\ntissue = \"nerve\"\nfile = \"RAS.stl\"\n"
      "[[structure]]\nname = \"b\"\ntissue = \"bone\"\nfile = \"LPS.stl\"\n"
      "[[structure]]\nname = \"c\"\ntissue = \"bone\"\nfile = \"none.stl\"\n");
  const JointSources sources(read_joint(folder.path()).value());
  const auto found = find_foreign_frames(sources);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what, "a");
  EXPECT_EQ(found[0].verdict, Verdict::refused);
  EXPECT_THAT(found[0].message, HasSubstr("SPACE=RAS, and joint.toml says axes = \"LPS\""));
}

TEST(ForeignFrames, TheNerveOfACaseIsRefused) {
  const auto folder = test::source_dir() / "../shared/cases/02-slicer-space-ignored";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared cases here";
  const JointSources sources(read_joint(folder).value());
  const auto found = find_foreign_frames(sources);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what, "axillary_nerve");
}

}  // namespace
}  // namespace artus
