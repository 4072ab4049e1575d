// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/pose_joint.h"

#include <cmath>

#include <gmock/gmock.h>

#include "artus/detail/anatomy/body/joint_digest.h"
#include "artus/detail/core/units.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

using testing::HasSubstr;

/// Muscle of 20 mm between two bones.
CompiledJoint bones_and_muscle() {
  const std::array<FlatLayer, 3> layers{{{"bone", 6e-3}, {"muscle", 20e-3}, {"bone", 6e-3}}};
  return test::make_meshed_block(layers, 40e-3, 40e-3, 2e-3);
}

JointPose turned(const std::string& bone, double degrees, const Vec3& shift = Vec3::Zero()) {
  BoneMotion motion{bone, Pose::Identity()};
  motion.X_J.linear() = Eigen::AngleAxisd(degrees * kDegree, Vec3::UnitZ()).toRotationMatrix();
  motion.X_J.translation() = shift;
  JointPose pose;
  pose.name = "turned";
  pose.motions = {motion};
  return pose;
}

TEST(PoseJoint, TissueBetweenTwoBonesIsWrungEvenly) {
  const CompiledJoint rest = bones_and_muscle();
  const auto posed = pose_joint(rest, turned("bone_2", 40));
  ASSERT_TRUE(posed) << posed.error().to_string();
  for (std::size_t v = 0; v < rest.mesh.vertices.size(); ++v) {
    const Vec3& p = rest.mesh.vertices[v];
    const double share = std::clamp((p.z() - 6e-3) / 20e-3, 0.0, 1.0);
    const Vec3 there = Eigen::AngleAxisd(share * 40 * kDegree, Vec3::UnitZ()) * p;
    EXPECT_LT((posed->joint.mesh.vertices[v] - there).norm(), 1e-6);
  }
  EXPECT_NEAR(posed->min_volume, 1, 0.02);
  EXPECT_NEAR(posed->max_volume, 1, 0.02);
  EXPECT_EQ(posed->turned_inside, 0);
  EXPECT_NE(compute_joint_digest(posed->joint), compute_joint_digest(rest));
}

TEST(PoseJoint, BonesAreRigidAndWhatStaysKeepsItsBytes) {
  const CompiledJoint rest = bones_and_muscle();
  const JointPose pose = turned("bone_2", 25, Vec3(1e-3, 0, 2e-3));
  const auto posed = pose_joint(rest, pose);
  ASSERT_TRUE(posed) << posed.error().to_string();
  for (std::size_t v = 0; v < rest.mesh.vertices.size(); ++v) {
    const Vec3& p = rest.mesh.vertices[v];
    if (p.z() < 6e-3 + 1e-9) {
      EXPECT_EQ(posed->joint.mesh.vertices[v], p);
    }
    if (p.z() > 26e-3 - 1e-9) {
      EXPECT_LT((posed->joint.mesh.vertices[v] - pose.motions[0].X_J * p).norm(), 1e-12);
    }
  }
}

TEST(PoseJoint, WhatIsPlacedInTissueGoesWithItAndFibresTurnHalfAsFar) {
  CompiledJoint rest = bones_and_muscle();
  for (Region& region : rest.regions) region.fibre_axis = Vec3::UnitX();
  rest.landmarks = {{"half way", Vec3(5e-3, 0, 16e-3)}};
  rest.injections = {{"into the turned bone", Vec3(0, 0, 2e-3), Vec3(4e-3, 0, 28e-3)}};
  const auto posed = pose_joint(rest, turned("bone_2", 40));
  ASSERT_TRUE(posed) << posed.error().to_string();
  const auto at = [](double degrees, const Vec3& p) -> Vec3 {
    return Eigen::AngleAxisd(degrees * kDegree, Vec3::UnitZ()) * p;
  };
  EXPECT_LT((posed->joint.landmarks[0].position - at(20, rest.landmarks[0].position)).norm(), 1e-6);
  EXPECT_LT((posed->joint.injections[0].target - at(40, rest.injections[0].target)).norm(), 1e-6);
  EXPECT_EQ(posed->joint.injections[0].entry, rest.injections[0].entry);
  const auto fibre_of = [&](const char* name) {
    return posed->joint.regions[region_named(posed->joint, name)].fibre_axis;
  };
  EXPECT_LT((fibre_of("muscle") - at(20, Vec3::UnitX())).norm(), 1e-3);
  EXPECT_LT((fibre_of("bone") - Vec3::UnitX()).norm(), 1e-12);
}

TEST(PoseJoint, SlackFilmTakesTheWayThatTissueDoesNot) {
  const std::array<FlatLayer, 5> layers{
      {{"bone", 4e-3}, {"muscle", 8e-3}, {"bursa", 2e-3}, {"muscle", 8e-3}, {"bone", 4e-3}}};
  const CompiledJoint rest = test::make_meshed_block(layers, 30e-3, 30e-3, 2e-3);
  const std::array<std::string, 1> bones{"bone_2"};
  const auto shares = compute_bone_shares(rest, bones);
  ASSERT_TRUE(shares);
  double roof = 0;
  double floor = 1;
  for (std::size_t v = 0; v < rest.mesh.vertices.size(); ++v) {
    const double z = rest.mesh.vertices[v].z();
    const double share = shares->of_vertex(static_cast<Eigen::Index>(v), 0);
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    if (std::abs(z - 12e-3) < 1e-9) roof = std::max(roof, share);
    if (std::abs(z - 14e-3) < 1e-9) floor = std::min(floor, share);
  }
  // 2 mm with a conductance of 0.02 beside twice 8 mm with 1: 100 of 116 parts of the way
  EXPECT_NEAR(floor - roof, 100.0 / 116, 0.01);
}

TEST(PoseJoint, RefusesWhatCannotBe) {
  const CompiledJoint rest = bones_and_muscle();
  const auto refusal = [&](const JointPose& pose) {
    const auto posed = pose_joint(rest, pose);
    return posed ? std::string() : posed.error().to_string();
  };
  EXPECT_THAT(refusal(turned("femur", 10)), HasSubstr("there is no bone 'femur'"));
  EXPECT_THAT(refusal(turned("muscle", 10)), HasSubstr("'muscle' is no bone"));
  EXPECT_THAT(refusal(turned("bone", 0, Vec3(0, 0, 23e-3))),
              HasSubstr("would run 3.0 mm into 'bone_2'"));
  EXPECT_THAT(refusal(turned("bone", 0, Vec3(0, 0, 40e-3))), HasSubstr("folded"));
  EXPECT_THAT(refusal(turned("bone", 175)), HasSubstr("half a turn"));
  JointPose bad = turned("bone", 10);
  bad.motions[0].X_J.linear()(0, 0) = std::nan("");
  EXPECT_THAT(refusal(bad), HasSubstr("not rigid"));
  EXPECT_EQ(refusal(turned("bone", 0, Vec3(0, 0, 4e-3))), "") << "squeezed is not folded";
}

TEST(PoseJoint, PoseWithoutMotionsIsTheJointItself) {
  CompiledJoint rest = bones_and_muscle();
  JointPose neutral;
  neutral.name = "neutral";
  rest.poses = {neutral};
  const auto posed = pose_joint(rest, find_pose(rest, "neutral").value());
  ASSERT_TRUE(posed);
  EXPECT_EQ(compute_joint_digest(posed->joint), compute_joint_digest(rest));
  EXPECT_EQ(find_pose(rest, "neutrl").error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace artus
