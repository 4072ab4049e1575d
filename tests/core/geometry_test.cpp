// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/core/geometry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/rigid.h"

namespace artus {
namespace {

TEST(MakePose, IsARotationWithZAlongTheRequestedAxis) {
  const Vec3 z(1, 2, -0.5);
  const Pose pose = make_pose(Vec3(3, 4, 5), z, Vec3(0, 0, 1));
  EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
  EXPECT_LT((pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
            1e-12);
  EXPECT_LT((pose.linear().col(2) - z.normalized()).norm(), 1e-12);
  EXPECT_GT(pose.linear().col(0).z(), 0);
  EXPECT_EQ(pose.translation(), Vec3(3, 4, 5));
}

TEST(MakePose, AParallelHintStillGivesARotation) {
  const Pose pose = make_pose(Vec3::Zero(), Vec3(0, 0, 2), Vec3(0, 0, 1));
  EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
}

TEST(IsRigid, RefusesWhatNoBodyCanDo) {
  const Pose pose = make_pose(Vec3(1, 2, 3), Vec3(1, 1, 0), Vec3::UnitZ());
  EXPECT_TRUE(is_rigid(pose));
  Pose stretched = pose;
  stretched.linear() *= 1 + 1e-5;
  EXPECT_FALSE(is_rigid(stretched));
  Pose mirrored = pose;
  mirrored.linear().col(0) *= -1;
  EXPECT_FALSE(is_rigid(mirrored));
  Pose lost = pose;
  lost.translation().y() = std::nan("");
  EXPECT_FALSE(is_rigid(lost));
}

TEST(RotationBetween, TurnsOneDirectionIntoTheOtherByTheSmallestAngle) {
  const Vec3 from = Vec3(1, 2, -0.5);
  for (const Vec3& to : {Vec3(0.3, -1, 4), Vec3(2, 4, -1), Vec3(-1, -2, 0.5)}) {
    const Eigen::Quaterniond turn = rotation_between(from, to);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-12);
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    EXPECT_NEAR(2 * std::atan2(turn.vec().norm(), std::abs(turn.w())), angle, 1e-7);
  }
}

}  // namespace
}  // namespace artus
