// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/led_session.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/training/assessment.h"
#include "artus/session/replay.h"
#include "tests/session/session_support.h"
#include "tests/support/meshed_block.h"

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

/// All numbers of a led session in a body that gives way, as JSON.
std::string numbers(RecordedPictures pictures, SightSource sights) {
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  const auto joint =
      std::make_shared<const CompiledJoint>(test::make_meshed_block(layers, 0.096, 0.064, 4e-3));
  const auto scene = std::make_shared<const Scene>(joint);
  std::vector<ListedPose> poses = straight_path();
  for (ListedPose& pose : poses) {
    pose.X_JP = joint->X_JP_default;
    pose.X_JP.translation() += 3e-3 * pose.X_JP.linear().col(2);
  }
  SessionParams params = test::make_small_session();
  params.deform = true;
  params.image_rate = 8;
  const auto recording = record_led_session(poses, scene, params, pictures);
  EXPECT_TRUE(recording);
  EXPECT_FALSE(recording->packets.empty());
  EXPECT_TRUE(
      std::any_of(recording->packets.begin(), recording->packets.end(),
                  [](const PacketRecord& p) { return p.packet.needle.compliance.points > 0; }))
      << "the needle feels the tissue, too";
  EXPECT_EQ(recording->frames.empty(), pictures == RecordedPictures::none);
  const auto assessed = assess_recording(*recording, scene, {}, sights);
  EXPECT_TRUE(assessed);
  const Metric* visible = find_metric(assessed->metrics, "tip_visible");
  EXPECT_EQ(visible != nullptr && visible->value, sights != SightSource::none);
  const Metric* force = find_metric(assessed->metrics, "force_peak_n:muscle");
  EXPECT_TRUE(force != nullptr && force->value.value_or(0) > 0.05);
  return to_json(*assessed).dump();
}

TEST(LedSession, IsAssessedToTheSameDigitsWhetherItsPicturesWereDrawnBeforeOrNot) {
  const std::string drawn = numbers(RecordedPictures::drawn, SightSource::recorded);
  EXPECT_EQ(drawn, numbers(RecordedPictures::listed, SightSource::recorded));
  EXPECT_EQ(drawn, numbers(RecordedPictures::drawn, SightSource::drawn));
  EXPECT_EQ(numbers(RecordedPictures::none, SightSource::none),
            numbers(RecordedPictures::drawn, SightSource::none));
}

}  // namespace
}  // namespace artus
