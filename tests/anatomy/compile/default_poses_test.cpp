// SPDX-License-Identifier: AGPL-3.0-or-later
// Where the probe and the needle stand when the joint file does not say.
#include "artus/detail/anatomy/compile/check/default_poses.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

constexpr double kSkin = 0.04;  // m, radius of the body
const std::vector<SphereLayer> kSoftBody{{"muscle", kSkin}};

TEST(DefaultPoses, GivenOnesStay) {
  JointFile file;
  file.X_JP_default = make_pose(Vec3(1, 2, 3), Vec3::UnitX(), Vec3::UnitY());
  file.X_JN_default = make_pose(Vec3(4, 5, 6), Vec3::UnitY(), Vec3::UnitX());
  std::vector<std::string> notes;
  const DefaultPoses poses = find_default_poses(file, test::make_nested_spheres(kSoftBody), notes);
  EXPECT_TRUE(poses.X_JP.isApprox(*file.X_JP_default));
  EXPECT_TRUE(poses.X_JN.isApprox(*file.X_JN_default));
  EXPECT_TRUE(notes.empty());
}

TEST(DefaultPoses, TheProbeStandsOnTheSkinNearestToTheNeedlesTipAcrossIt) {
  JointFile file;
  file.X_JN_default = make_pose(Vec3(0, 0.02, 0), Vec3::UnitX(), Vec3::UnitY());
  std::vector<std::string> notes;
  const DefaultPoses poses = find_default_poses(file, test::make_nested_spheres(kSoftBody), notes);
  EXPECT_NEAR(poses.X_JP.translation().norm(), kSkin, 0.3e-3);
  EXPECT_NEAR((poses.X_JP.translation() - Vec3(0, kSkin, 0)).norm(), 0, 5e-3);
  const Vec3 beam = poses.X_JP.linear().col(2);
  const Vec3 to_tip = (Vec3(0, 0.02, 0) - poses.X_JP.translation()).normalized();
  EXPECT_NEAR(beam.dot(to_tip), 1, 1e-9) << "it looks at the tip";
  EXPECT_NEAR(poses.X_JP.linear().col(1).dot(Vec3::UnitX()), 0, 1e-9)
      << "the needle is in its plane";
  EXPECT_EQ(notes.size(), 1U) << "what was chosen is told";
}

TEST(DefaultPoses, TheProbeLooksPastBone) {
  // Bone under the skin on the side that is nearest to the tip.
  CompiledJoint joint = test::make_block_with_sphere(
      {"muscle", Vec3(0.2, 0.2, 0.08), Vec3::Zero(), "bone", Vec3(0, 0, 0.015), 0.012});
  JointFile file;
  file.X_JN_default = make_pose(Vec3(0, 0, 0.035), Vec3::UnitX(), Vec3::UnitY());
  std::vector<std::string> notes;
  const Vec3 probe = find_default_poses(file, joint, notes).X_JP.translation();
  // The line from the probe to the tip passes the ball of bone.
  const Vec3 beam = (Vec3(0, 0, 0.035) - probe).normalized();
  const Vec3 to_bone = Vec3(0, 0, 0.015) - probe;
  EXPECT_GT((to_bone - to_bone.dot(beam) * beam).norm(), 0.012);
}

TEST(DefaultPoses, TheFirstPlannedInjectionIsTheNeedle) {
  JointFile file;
  file.injections = {{"first", Vec3(kSkin, 0, 0), Vec3(0.02, 0.01, 0)}, {"second", {}, {}}};
  std::vector<std::string> notes;
  const DefaultPoses poses = find_default_poses(file, test::make_nested_spheres(kSoftBody), notes);
  EXPECT_TRUE(poses.X_JN.translation().isApprox(Vec3(0.02, 0.01, 0)));
  EXPECT_TRUE(poses.X_JN.linear().col(2).isApprox(Vec3(-0.02, 0.01, 0).normalized()));
  EXPECT_EQ(notes.size(), 2U);
}

TEST(DefaultPoses, WithNothingGivenTheNeedleComesAtHalfARightAngleToTwentyMillimetres) {
  JointFile file;
  file.region_of_interest = RegionOfInterest{Vec3(0, 0, -0.01), 0.05, std::nullopt};
  std::vector<std::string> notes;
  CompiledJoint joint = test::make_nested_spheres(std::vector<SphereLayer>{{"muscle", 0.07}});
  const DefaultPoses poses = find_default_poses(file, joint, notes);
  EXPECT_NEAR((poses.X_JP.inverse() * poses.X_JN.translation() - Vec3(0, 0, 20e-3)).norm(), 0,
              1e-9);
  EXPECT_NEAR(poses.X_JP.linear().col(2).dot(poses.X_JN.linear().col(2)), std::sqrt(0.5), 1e-9);
  EXPECT_EQ(notes.size(), 2U);
}

}  // namespace
}  // namespace artus
