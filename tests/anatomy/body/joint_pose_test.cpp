// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/joint_pose.h"

#include <array>

#include <gtest/gtest.h>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/body/joint_pose_bytes.h"
#include "tests/support/layered_body.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

class JointPoseFile : public test::TemporaryFolder {};

TEST(JointPose, BytesThatAreNoRigidMotionAreRefused) {
  ByteWriter out;
  Pose sheared = Pose::Identity();
  sheared.matrix()(0, 1) = 0.1;
  put_poses(out, {{"bent", "", {{"ulna", sheared}}, {}}});
  ByteReader in(out.bytes());
  static_cast<void>(get_poses(in));
  EXPECT_FALSE(in.ok());
}

TEST_F(JointPoseFile, IsKeptInACompiledFile) {
  const std::array<test::FlatLayer, 1> layers{{{"muscle", 10e-3}}};
  CompiledJoint joint = test::make_layered_block(layers, 20e-3, 20e-3);
  BoneMotion motion{"ulna", Pose::Identity()};
  motion.X_J = Eigen::Translation3d(1e-3, 2e-3, 3e-3) * Eigen::AngleAxisd(0.4, Vec3::UnitY());
  joint.poses = {{"bent", "a bent arm", {motion}, Pose::Identity()}, {"straight", "", {}, {}}};
  const std::string file = in("posed.artus");
  ASSERT_TRUE(write_compiled_joint(joint, file));
  const auto read = read_compiled_joint(file);
  ASSERT_TRUE(read) << read.error().to_string();
  ASSERT_EQ(read->poses.size(), 2U);
  EXPECT_EQ(read->poses[0].title, "a bent arm");
  EXPECT_EQ(read->poses[0].motions[0].X_J.matrix(), motion.X_J.matrix());
  EXPECT_TRUE(read->poses[0].X_JP);
  EXPECT_FALSE(read->poses[1].X_JP);
}

}  // namespace
}  // namespace artus
