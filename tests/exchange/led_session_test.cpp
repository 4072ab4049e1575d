// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/exchange/led_session.h"

#include <vector>

#include <gtest/gtest.h>

#include "artus/session/replay.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

/// The needle from 5 mm above the skin to 15 mm below in a second, the probe beside it.
std::vector<ListedPose> straight_path() {
  std::vector<ListedPose> poses(2);
  for (std::size_t i = 0; i < 2; ++i) {
    poses[i].time = static_cast<double>(i);
    poses[i].X_JP = make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX());
    poses[i].X_JN = make_pose(Vec3(0, 0, i == 0 ? -5e-3 : 15e-3), Vec3::UnitZ(), Vec3::UnitX());
  }
  return poses;
}

TEST(LedSession, HasTheTicksAndImagesThatTheTimesSay) {
  const auto scene = test::make_layered_scene();
  const auto recording = record_led_session(straight_path(), scene, test::make_small_session());
  ASSERT_TRUE(recording) << recording.error().to_string();
  EXPECT_EQ(recording->ticks.size(), 1001U);
  EXPECT_EQ(recording->frames.size(), 31U);  // 30 a second
  std::uint64_t last = 0;
  for (const TickRecord& tick : recording->ticks) {
    ASSERT_EQ(find_fault(tick, last), nullptr) << find_fault(tick, last);
    last = tick.input.tick;
  }
  last = 0;
  for (const FrameRecord& frame : recording->frames) {
    ASSERT_EQ(find_fault(frame, last), nullptr) << find_fault(frame, last);
    last = frame.input.number;
  }
  EXPECT_NEAR(recording->frames[15].input.X_JN.position[2], 5e-3, 0.05e-3);
}

TEST(LedSession, IsFeltAndReplaysToTheSameBytes) {
  const auto scene = test::make_layered_scene();
  const auto recording = record_led_session(straight_path(), scene, test::make_small_session());
  ASSERT_TRUE(recording);
  double deepest = 0;
  double strongest = 0;
  ReplayListener listener;
  listener.on_tick = [&](const HapticSnapshot& tick) {
    deepest = std::max(deepest, tick.feedback.depth);
    strongest = std::max(strongest, -tick.force_J[2]);
  };
  const auto report = replay(*recording, scene, listener);
  ASSERT_TRUE(report) << report.error().to_string();
  EXPECT_TRUE(report->identical());
  EXPECT_EQ(report->frames, 31U);
  EXPECT_NEAR(deepest, 15e-3, 1e-3);
  EXPECT_GT(strongest, 0.2);
}

TEST(LedSession, ANeedleThatIsNotListedIsNotThere) {
  std::vector<ListedPose> poses = straight_path();
  for (ListedPose& pose : poses) pose.X_JN.reset();
  const auto recording =
      record_led_session(poses, test::make_layered_scene(), test::make_small_session());
  ASSERT_TRUE(recording);
  for (const TickRecord& tick : recording->ticks) {
    EXPECT_EQ(tick.input.device.has_needle, 0U);
    EXPECT_EQ(tick.force[2], 0);
  }
  poses[1].time.reset();
  EXPECT_FALSE(record_led_session(poses, test::make_layered_scene(), test::make_small_session()));
}

}  // namespace
}  // namespace artus
