// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/guard.h"

#include <limits>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kDt = 1e-3;
const DeviceLimits kDevice = find_device("virtuose_6d_desktop").value();

TimedPose pose_at(double x, double time) {
  TimedPose pose;
  pose.X_JN.translation() = Vec3(x, 0, 0);
  pose.time = time;
  return pose;
}

TEST(InputGuard, NamesEachFault) {
  InputGuard guard(GuardParams{}, kDt);
  EXPECT_EQ(guard.check(pose_at(0, 0)), 0U);
  EXPECT_EQ(guard.check(pose_at(1e-4, 1e-3)), 0U);
  EXPECT_EQ(guard.check(pose_at(std::numeric_limits<double>::quiet_NaN(), 2e-3)),
            TickStatus::kNotFinite);
  EXPECT_EQ(guard.check(pose_at(std::numeric_limits<double>::infinity(), 2e-3)),
            TickStatus::kNotFinite);
  TimedPose skewed = pose_at(1e-4, 2e-3);
  skewed.X_JN.linear()(0, 1) = 0.1;
  EXPECT_EQ(guard.check(skewed), TickStatus::kNotRigid);
  TimedPose mirrored = pose_at(1e-4, 2e-3);
  mirrored.X_JN.linear()(2, 2) = -1;
  EXPECT_EQ(guard.check(mirrored), TickStatus::kNotRigid);
  EXPECT_EQ(guard.check(pose_at(0.5, 3e-3)), TickStatus::kTeleport);
  EXPECT_EQ(guard.check(pose_at(0.5, 4e-3)), 0U) << "the needle is where it landed";
  EXPECT_EQ(guard.check(pose_at(0.5, 3e-3)), TickStatus::kTimeReversed);
  EXPECT_EQ(guard.check(pose_at(0.5, 4e-3)), 0U);
}

TEST(InputGuard, FrozenPoseIsStaleAfterItsTime) {
  InputGuard guard(GuardParams{}, kDt);
  int ticks = 0;
  EXPECT_EQ(guard.check(pose_at(0, 0)), 0U);
  while (guard.check(pose_at(0, 0)) == 0 && ticks < 1000) ++ticks;
  EXPECT_NEAR(ticks * kDt, GuardParams{}.stale_after, 2 * kDt);
  EXPECT_EQ(guard.check(pose_at(0, 0.03)), 0U) << "a newer pose ends it";
}

TEST(InputGuard, OutOfWorkspaceIsAFault) {
  GuardParams params;
  params.workspace_half = Vec3::Constant(0.1);
  InputGuard guard(params, kDt);
  EXPECT_EQ(guard.check(pose_at(0.2, 0)), TickStatus::kOutOfWorkspace);
}

TEST(OutputGuard, WhatADeviceDoesNotRenderIsNoLimitReached) {
  DeviceLimits sensed = kDevice;
  sensed.torque = 0;
  const Wrench wanted{Vec3(0, 0, -0.06), Vec3(0, 0.02, 0)};
  OutputGuard guard({}, sensed, kDt);
  std::uint32_t status = 0;
  EXPECT_EQ(guard.apply(wanted, 0, status).torque, Vec3::Zero());
  EXPECT_EQ(status & TickStatus::kSaturated, 0U);
  sensed.torque = 0.01;
  OutputGuard weak({}, sensed, kDt);
  static_cast<void>(weak.apply(wanted, 0, status));
  EXPECT_NE(status & TickStatus::kSaturated, 0U);
}

TEST(OutputGuard, RampsUpLimitsAndDropsToZeroAtOnce) {
  GuardParams params;
  OutputGuard guard(params, kDevice, kDt);
  const Wrench wanted{Vec3(0, 0, -20), Vec3::Zero()};
  double last = 0;
  for (int i = 1; i <= 400; ++i) {
    std::uint32_t status = 0;
    const Wrench out = guard.apply(wanted, 0, status);
    EXPECT_LE(out.force.norm(), kDevice.force + 1e-12);
    EXPECT_LE(out.force.norm(), kDevice.force * i * kDt / params.ramp_time + 1e-9);
    EXPECT_GE(out.force.norm(), last - 1e-12);
    EXPECT_NE(status & TickStatus::kSaturated, 0U);
    last = out.force.norm();
  }
  EXPECT_NEAR(last, kDevice.force, 1e-12);
  std::uint32_t status = 0;
  EXPECT_EQ(guard.apply(wanted, TickStatus::kStale, status).force.norm(), 0);
  status = 0;
  EXPECT_LE(guard.apply(wanted, 0, status).force.norm(),
            kDevice.force * kDt / params.ramp_time + 1e-9);
  EXPECT_NE(status & TickStatus::kRamping, 0U);
}

TEST(OutputGuard, StepIsSlewLimitedAndNanIsZero) {
  GuardParams params;
  params.ramp_time = 1e-3;
  params.force_slew = 1000;
  OutputGuard guard(params, kDevice, kDt);
  std::uint32_t status = 0;
  EXPECT_NEAR(guard.apply({Vec3(5, 0, 0), Vec3::Zero()}, 0, status).force.x(), 1.0, 1e-12);
  EXPECT_NE(status & TickStatus::kSlewLimited, 0U);
  status = 0;
  const Vec3 nan = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(guard.apply({nan, Vec3::Zero()}, 0, status).force.norm(), 0);
  EXPECT_NE(status & TickStatus::kLawNotFinite, 0U);
}

}  // namespace
}  // namespace artus
