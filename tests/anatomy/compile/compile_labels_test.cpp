// SPDX-License-Identifier: AGPL-3.0-or-later
// From a joint file and its surfaces to labels: order of priority, constructs, sizes.
#include "artus/detail/anatomy/compile/labels/compile_labels.h"

#include <gtest/gtest.h>

#include "tests/anatomy/compile/balls_joint.h"

namespace artus {
namespace {

using test::BallsJoint;

constexpr double kMm = 1e-3;

TEST(LabelledSpace, TheFilesOrderIsThePriorityAndTheFillerTakesTheRest) {
  const BallsJoint joint(30 * kMm, {{"a", "muscle", Vec3(-8 * kMm, 0, 0), 12 * kMm},
                                    {"b", "bone", Vec3(8 * kMm, 0, 0), 12 * kMm}});
  const auto space = make_labelled_space(joint.file, joint.surfaces, {});
  ASSERT_TRUE(space) << space.error().to_string();
  EXPECT_EQ(space->labels.at(Vec3::Zero()), region_of_structure(0)) << "both hold it; a is first";
  EXPECT_EQ(space->labels.at(Vec3(12 * kMm, 0, 0)), region_of_structure(1));
  EXPECT_EQ(space->labels.at(Vec3(0, 20 * kMm, 0)), kFirstRegion);
  EXPECT_EQ(space->labels.at(Vec3(0, 31 * kMm, 0)), kOutside);
}

TEST(LabelledSpace, AShellLinesTheBodyAndComesFirstWhereItIsFirst) {
  BallsJoint joint(30 * kMm, {});
  joint.add_construct("skin", ShellConstruct{"", 2 * kMm});
  const auto space = make_labelled_space(joint.file, joint.surfaces, {});
  ASSERT_TRUE(space) << space.error().to_string();
  EXPECT_EQ(space->labels.at(Vec3(0, 0, 29 * kMm)), region_of_structure(0));
  EXPECT_EQ(space->labels.at(Vec3(0, 0, 27 * kMm)), kFirstRegion);
}

TEST(LabelledSpace, AnEndTakesItsShareBeforeTheMuscleItIsCutFrom) {
  BallsJoint joint(40 * kMm, {{"muscle", "muscle", Vec3(-10 * kMm, 0, 0), 12 * kMm},
                              {"bone", "bone", Vec3(10 * kMm, 0, 0), 9 * kMm}});
  joint.add_construct("tendon", EndConstruct{"muscle", "bone", 8 * kMm, Vec3(1 * kMm, 0, 0)});
  const auto space = make_labelled_space(joint.file, joint.surfaces, {});
  ASSERT_TRUE(space) << space.error().to_string();
  EXPECT_EQ(space->labels.layers.front().region, region_of_structure(2));
  EXPECT_EQ(space->labels.at(Vec3(-3 * kMm, 0, 0)), region_of_structure(2));
  EXPECT_EQ(space->labels.at(Vec3(-12 * kMm, 0, 0)), region_of_structure(0));
}

TEST(LabelledSpace, AThinStructureGetsAFinerMesh) {
  const BallsJoint joint(30 * kMm, {{"large", "muscle", Vec3(-8 * kMm, 0, 0), 12 * kMm},
                                    {"small", "nerve", Vec3(15 * kMm, 0, 0), 2 * kMm}});
  const auto space = make_labelled_space(joint.file, joint.surfaces, {});
  ASSERT_TRUE(space) << space.error().to_string();
  const auto& sizing = space->resolve.sizing;
  EXPECT_DOUBLE_EQ(sizing[region_of_structure(0)].facet_size, joint.file.facet_size);
  EXPECT_LT(sizing[region_of_structure(1)].facet_size, joint.file.facet_size);
  EXPECT_LT(sizing[region_of_structure(1)].facet_distance, joint.file.facet_distance);
}

TEST(LabelledSpace, ARegionOfInterestBesideTheBodyIsRefused) {
  BallsJoint joint(30 * kMm, {});
  joint.file.region_of_interest = RegionOfInterest{Vec3(1, 0, 0), 0.02, std::nullopt};
  const auto space = make_labelled_space(joint.file, joint.surfaces, {});
  ASSERT_FALSE(space);
  EXPECT_EQ(space.error().code, ErrorCode::failed);
}

TEST(LabelledSpace, TellsItsProgress) {
  const BallsJoint joint(20 * kMm, {{"a", "muscle", Vec3::Zero(), 8 * kMm}});
  double last = 0;
  int told = 0;
  const Progress progress = [&](std::string_view step, double fraction) {
    EXPECT_FALSE(step.empty());
    EXPECT_GE(fraction, last);
    last = fraction;
    ++told;
  };
  ASSERT_TRUE(make_labelled_space(joint.file, joint.surfaces, progress));
  EXPECT_EQ(told, 2) << "the body and the structure";
}

}  // namespace
}  // namespace artus
