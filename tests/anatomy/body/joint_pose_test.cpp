// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/joint_pose.h"

#include <array>
#include <filesystem>

#include <sys/stat.h>

#include <gtest/gtest.h>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/body/joint_digest.h"
#include "artus/detail/anatomy/body/joint_pose_bytes.h"
#include "artus/detail/anatomy/body/standard_view.h"
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

/// A compiled file comes in place of what was there by one move: never of a device.
TEST_F(JointPoseFile, ADeviceOrAFolderIsNotReplacedByACompiledFile) {
  const std::array<test::FlatLayer, 1> layers{{{"muscle", 10e-3}}};
  const CompiledJoint joint = test::make_layered_block(layers, 20e-3, 20e-3);
  const std::string pipe = in("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string folder = in("folder");
  std::filesystem::create_directories(folder);
  for (const std::string& place : {pipe, folder}) {
    const auto written = write_compiled_joint(joint, place);
    ASSERT_FALSE(written) << place;
    EXPECT_EQ(written.error().where, place);
  }
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_TRUE(std::filesystem::is_directory(folder));
}

StandardView groove_view() {
  StandardView view;
  view.name = "groove";
  view.title = "groove, short axis";
  view.source = "[ESSRshoulder]";
  view.shows = "a tendon in a groove";
  view.X_JP = Eigen::Translation3d(1e-3, 2e-3, 3e-3) * Eigen::AngleAxisd(0.4, Vec3::UnitY());
  view.depth = 40e-3;
  view.sights = {{"muscle", 1e-3, 5e-3, ViewSide::right}};
  return view;
}

TEST_F(JointPoseFile, ViewsAreKeptInACompiledFileWithoutPoses) {
  const std::array<test::FlatLayer, 1> layers{{{"muscle", 10e-3}}};
  CompiledJoint joint = test::make_layered_block(layers, 20e-3, 20e-3);
  const std::string without = compute_joint_digest(joint);
  joint.views = {groove_view()};
  EXPECT_EQ(compute_joint_digest(joint), without) << "the same body, looked at from elsewhere";
  const std::string file = in("viewed.artus");
  ASSERT_TRUE(write_compiled_joint(joint, file));
  const auto read = read_compiled_joint(file);
  ASSERT_TRUE(read) << read.error().to_string();
  ASSERT_EQ(read->views.size(), 1U);
  const StandardView& view = read->views[0];
  EXPECT_EQ(view.title, "groove, short axis");
  EXPECT_EQ(view.shows, "a tendon in a groove");
  EXPECT_EQ(view.X_JP.matrix(), joint.views[0].X_JP.matrix());
  EXPECT_EQ(view.depth, 40e-3);
  EXPECT_EQ(view.sights, joint.views[0].sights);
}

TEST(StandardView, IsFoundByItsNameAndByWhereTheProbeStands) {
  CompiledJoint joint;
  joint.name = "block";
  joint.views = {groove_view()};
  EXPECT_EQ(view_at_default_probe(joint), nullptr);
  const auto found = find_view(joint, "groove");
  ASSERT_TRUE(found);
  joint.X_JP_default = found->X_JP;
  EXPECT_EQ(view_at_default_probe(joint), &joint.views[0]);
  const auto other = find_view(joint, "grove");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("groove"), std::string::npos) << other.error().message;
}

}  // namespace
}  // namespace artus
