// SPDX-License-Identifier: AGPL-3.0-or-later
// Closed forms of a needle in a block whose top is the plane z = 0.
#include "artus/detail/training/metrics/raw_motion.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

class RawMotionTest : public testing::Test {
 protected:
  double value(const RawMotion& motion, const char* name) {
    const auto metrics = motion.metrics("Needle");
    const Metric* metric = find_metric(metrics, name);
    EXPECT_NE(metric, nullptr) << name;
    return metric != nullptr ? metric->value.value_or(NAN) : NAN;
  }
  std::shared_ptr<const Scene> block_ = test::make_layered_scene();
  RawMotion motion_{block_, true};
};

TEST_F(RawMotionTest, AMatrixOffARotationIsTakenAsItIs) {
  // Two matrices of six digits whose step is a quarter turn but for what the first one's scale
  // leaves: M2 M1^-1 has the rotation nearest to it, not that of the two nearest rotations.
  Eigen::Matrix3d first = Eigen::Matrix3d::Identity();
  first(0, 1) = 2e-3;  // sheared: not a rotation
  const Eigen::AngleAxisd quarter(1.5, Vec3::UnitZ());
  const Eigen::Matrix3d second = quarter.toRotationMatrix();
  Pose pose = Pose::Identity();
  motion_.add(0, pose, first);
  pose.linear() = second;
  motion_.add(1, pose, second);
  // the shear's rotation is half of it, about z: its inverse turns the other way by atan(s / 2)
  const double sheared = std::atan2(2e-3, 2.0);
  EXPECT_NEAR(value(motion_, "Rotation Total"), (1.5 + sheared) / kDegree, 1e-9);
  RawMotion rigid(block_, true);
  rigid.add(0, Pose::Identity());
  rigid.add(1, pose);
  EXPECT_NEAR(value(rigid, "Rotation Total"), 1.5 / kDegree, 1e-9);
}

TEST_F(RawMotionTest, StraightInAndOutSweepsNothingAndWalksTwiceTheDepth) {
  for (int i = 0; i <= 200; ++i) {
    const double z = 1e-3 * (i <= 100 ? i : 200 - i) * 0.2 - 1e-9;
    motion_.add(0.01 * i, make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX()));
  }
  EXPECT_NEAR(value(motion_, "Tissue Damage"), 0, 1e-6);
  EXPECT_NEAR(value(motion_, "Path Length"), 40, 1e-9);
  EXPECT_NEAR(value(motion_, "Elapsed Time"), 2, 1e-12);
  EXPECT_EQ(value(motion_, "Tissue Punctures"), 1);
}

TEST_F(RawMotionTest, ATiltAboutTheEntrySweepsASector) {
  constexpr int kSteps = 1000;
  const double depth = 0.02;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 0.5 * i / kSteps - 0.25;
    const Vec3 axis(std::sin(angle), 0, std::cos(angle));
    motion_.add(0.01 * i, make_pose(depth * axis, axis, Vec3::UnitY()));
  }
  EXPECT_NEAR(value(motion_, "Tissue Damage"), 0.5 * 20 * 20 * 0.5, 2e-4);
}

TEST_F(RawMotionTest, AShiftSweepsARectangleAndACircleACylinder) {
  RawMotion circle(block_, true);
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    motion_.add(0.01 * i,
                make_pose(Vec3(0.007 * i / kSteps, 0, 0.02), Vec3::UnitZ(), Vec3::UnitX()));
    const double angle = 2 * 3.141592653589793 * i / kSteps;
    circle.add(0.01 * i, make_pose(Vec3(0.005 * std::cos(angle), 0.005 * std::sin(angle), 0.02),
                                   Vec3::UnitZ(), Vec3::UnitX()));
  }
  EXPECT_NEAR(value(motion_, "Tissue Damage"), 20 * 7, 1e-6);
  EXPECT_NEAR(value(circle, "Tissue Damage"), 2 * 3.141592653589793 * 5 * 20, 1e-3);
}

TEST_F(RawMotionTest, AStepCountsWhereItEnds) {
  const auto at = [](double z) {
    return make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX());
  };
  motion_.add(0, at(-2e-3));
  motion_.add(1, at(3e-3));   // ends inside
  motion_.add(3, at(-4e-3));  // ends outside
  EXPECT_NEAR(value(motion_, "Path in Tissue"), 5, 1e-9);
  EXPECT_NEAR(value(motion_, "Time in Tissue"), 1, 1e-12);
}

TEST_F(RawMotionTest, ActionsAreOfTheWorldsOrigin) {
  // A turn about a far tip carries the origin along though the tip rests.
  RawMotion still(nullptr, true);
  for (int i = 0; i <= 300; ++i) {
    const double angle = i < 100 ? 0 : (i < 200 ? 1e-2 * (i - 100) : 1.0);
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
    pose.translation() = Vec3(0.3, 0, 0);
    still.add(0.01 * i, pose);
  }
  EXPECT_EQ(value(still, "Translational Actions"), 1);
  EXPECT_EQ(value(still, "Rotational Actions"), 1);
  EXPECT_NEAR(value(still, "Path Length"), 0, 1e-9);
}

TEST_F(RawMotionTest, PosesOfOneTimeMoveWithoutSpeed) {
  const auto at = [](double x) {
    return make_pose(Vec3(x, 0, 0), Vec3::UnitZ(), Vec3::UnitX());
  };
  for (int i = 0; i < 20; ++i) {
    motion_.add(0.1 * i, at(1e-3 * i));
    motion_.add(0.1 * i, at(1e-3 * i));
  }
  EXPECT_NEAR(value(motion_, "Path Length"), 19, 1e-9);
  EXPECT_TRUE(std::isfinite(value(motion_, "Motion Smoothness")));
  EXPECT_EQ(value(motion_, "Translational Actions"), 0);
}

TEST_F(RawMotionTest, SmoothnessOfAThirdPowerIsItsJerk) {
  RawMotion cubic(nullptr, true);
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.01 * i;
    cubic.add(t, make_pose(Vec3(t * t * t, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  }
  EXPECT_NEAR(value(cubic, "Motion Smoothness"), std::sqrt(36 * 0.98) * 1e3, 1e-3);
}

TEST(ClosedBody, ABlockOfItsOwnTrianglesHasInsideEntryAndDistance) {
  const auto scene = test::make_layered_scene();
  const auto muscle = make_region_body(scene->joint(), region_named(scene->joint(), "muscle"));
  ASSERT_NE(muscle, nullptr);
  EXPECT_NEAR(muscle->signed_distance_to_skin(Vec3(0, 0, 1e-3), 1), 6e-3, 1e-12);
  EXPECT_NEAR(muscle->signed_distance_to_skin(Vec3(0, 0, 10e-3), 1), -3e-3, 1e-12);
  const auto entry = find_entry(*scene, Vec3(0, 0, 0.02), Vec3(0.6, 0, 0.8));
  ASSERT_TRUE(entry);
  EXPECT_NEAR(entry->z(), 0, 1e-12);
  EXPECT_NEAR(entry->x(), -0.015, 1e-12);
  EXPECT_FALSE(find_entry(*scene, Vec3(0, 0, -0.02), Vec3::UnitZ()));
}

}  // namespace
}  // namespace artus
