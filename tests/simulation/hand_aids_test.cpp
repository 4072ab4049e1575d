// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/hand_aids.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/simulation/haptic_core.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

/// The force in a session whose needle goes straight in, with the planned line 2 mm beside it.
class HandAidTest : public ::testing::Test {
 protected:
  HandAidTest() { params_.aids.entry = Vec3(2e-3, 0, 0); }
  /// N, frame J, with the tip driven in to `depth`.
  Vec3 force_at(double depth) {
    params_.aids.target = params_.aids.entry + Vec3(0, 0, 0.05);
    EXPECT_TRUE(validate(params_));
    HapticCore core(scene_, params_);
    std::uint64_t tick = 0;
    Vec3 force = Vec3::Zero();
    for (double z = -10e-3; z < depth; z += 20e-6) {
      TickInput input;
      input.tick = ++tick;
      input.device = test::sample_at(z, static_cast<std::int64_t>(tick) * test::kTickTime, tick);
      const HapticSnapshot& out = core.step(input);
      force = Vec3(out.force_J[0], out.force_J[1], out.force_J[2]);
      EXPECT_LE(force.norm(), 11);
    }
    return force;
  }
  std::shared_ptr<const Scene> scene_ = test::make_layered_scene();
  SessionParams params_ = test::make_small_session();
};

TEST_F(HandAidTest, TheGuideDrawsAcrossToTheLineAsASpring) {
  const Vec3 without = force_at(12e-3);
  params_.aids.guide = 200;
  const Vec3 with = force_at(12e-3);
  EXPECT_NEAR((with - without).x(), 200 * 2e-3, 1e-9);
  EXPECT_NEAR((with - without).y(), 0, 1e-12);
  EXPECT_NEAR((with - without).z(), 0, 1e-12);
  params_.aids.entry = Vec3::Zero();
  EXPECT_NEAR((force_at(12e-3) - without).norm(), 0, 1e-12);
}

TEST_F(HandAidTest, TheGuideBeginsGentlyAndIsLimited) {
  params_.aids.guide = 1000;
  params_.aids.entry = Vec3(8e-3, 0, 0);
  EXPECT_NEAR(force_at(12e-3).x(), HandAid::kMaxForce, 1e-6);
  EXPECT_EQ(force_at(-2e-3).x(), 0);
  params_.aids.entry = Vec3(2e-3, 0, 0);
  EXPECT_LT(force_at(3e-3).x(), 0.7 * 1000 * 2e-3);
}

TEST_F(HandAidTest, TheWallPushesBackWithinWhatIsToBeAvoidedAndNowhereElse) {
  const Vec3 in_muscle = force_at(14e-3);
  const Vec3 in_bursa = force_at(23.5e-3);
  params_.aids.wall = 1000;
  params_.aids.keep_out = "no such\nbursa";
  EXPECT_NEAR((force_at(14e-3) - in_muscle).norm(), 0, 1e-12);
  const Vec3 more = force_at(23.5e-3) - in_bursa;
  EXPECT_LT(more.z(), -0.2);
  EXPECT_GE(more.z(), -1000 * 1.6e-3);  // it came in at 22 mm
  EXPECT_NEAR(more.x(), 0, 1e-9);
}

TEST_F(HandAidTest, ComesAndGoesWithoutAJumpAndIsZeroWhileTheSessionDoesNotRun) {
  params_.aids.guide = 1000;
  params_.aids.target = params_.aids.entry + Vec3(0, 0, 0.05);
  HapticCore core(scene_, params_);
  std::uint64_t tick = 0;
  double last = 0;
  double largest = 0;
  double z = -10e-3;
  const auto run = [&](int ticks, double step, std::uint32_t command) {
    for (int k = 0; k < ticks; ++k) {
      TickInput input;
      input.tick = ++tick;
      input.command = command;
      z += step;
      input.device = test::sample_at(z, static_cast<std::int64_t>(tick) * test::kTickTime, tick);
      const double aside = core.step(input).force_J[0];
      if (command == 0) largest = std::max(largest, std::abs(aside - last));
      last = aside;
    }
  };
  run(1100, 20e-6, 0);
  EXPECT_NEAR(last, 2, 1e-6);
  run(300, 0, SessionCommand::kPause);
  EXPECT_EQ(last, 0);
  run(100, 0, 0);
  EXPECT_NEAR(last, 1, 1e-6) << "the guard's ramp takes 0.2 s";
  run(100, 0, 0);
  EXPECT_NEAR(last, 2, 1e-6);
  run(400, -100e-6, 0);
  EXPECT_EQ(last, 0) << "out again";
  EXPECT_LE(largest, HandAid::kSlew * 1e-3 + 1e-9);
}

TEST_F(HandAidTest, WhatIsNoStiffnessIsRefused) {
  params_.aids.guide = -1;
  EXPECT_FALSE(validate(params_));
  params_.aids.guide = 1e6;
  EXPECT_FALSE(validate(params_));
  params_.aids.guide = 0;
  params_.aids.target = Vec3(100, 0, 0);
  EXPECT_FALSE(validate(params_));
}

}  // namespace
}  // namespace artus
