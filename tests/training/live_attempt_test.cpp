// SPDX-License-Identifier: AGPL-3.0-or-later
// A running session measures itself: with its threads, its device and its pictures as they come.
#include "artus/detail/training/live_attempt.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "artus/detail/training/session_meter.h"
#include "artus/simulation/simulation.h"
#include "tests/session/session_support.h"
#include "tests/support/real_time.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

class LiveAttemptTest : public test::TemporaryFolder {};

MeterOptions short_options(const RecordingHead& head) {
  MeterOptions options = options_for(head);
  options.longest = 120;
  return options;
}

TEST_F(LiveAttemptTest, ARunningSessionSaysWhatItsRecordingSays) {
  const auto scene = test::make_layered_scene();
  const SessionParams params = test::make_small_session();
  const RecordingHead head = make_head(scene->joint(), params);
  LiveAttempt live(scene, short_options(head), params.haptic_rate);
  Session::Options options;
  options.haptic_options = {};
  options.imaging_options = {};
  options.recording = in("session.rec");
  options.observer = &live;
  auto session = Session::start(scene, params, test::make_injecting_hand(), options);
  ASSERT_TRUE(session) << session.error().to_string();
  // A machine with ten other jobs makes a picture in ten seconds.
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (((*session)->ticks() < 2500 || (*session)->frames() < 10) &&
         std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ((*session)->unrecorded(), 0U);
  session->reset();
  const auto recording = read_recording(in("session.rec"));
  ASSERT_TRUE(recording) << recording.error().to_string();
  ASSERT_GE(recording->frames.size(), 10U);
  const auto replayed = assess(*recording, scene, short_options(head), SightSource::drawn);
  ASSERT_TRUE(replayed);
  const AttemptMeasures measured = live.measure();
  EXPECT_EQ(to_json(measured.metrics).dump(), to_json(replayed->metrics).dump());
  EXPECT_EQ(to_json(measured.raw).dump(), to_json(replayed->raw).dump());
  EXPECT_TRUE(find_metric(measured.metrics, "tip_visible")->value);
  EXPECT_TRUE(find_metric(measured.metrics, "path_length_mm")->value);
}

TEST_F(LiveAttemptTest, TakesATickWithoutMemoryEvenWhenItIsFull) {
  const auto scene = test::make_layered_scene();
  const SessionParams params = test::make_small_session();
  MeterOptions options = options_for(make_head(scene->joint(), params));
  options.longest = 1;
  LiveAttempt live(scene, options, params.haptic_rate);
  Simulation haptics(scene, params);
  TickInput input;
  for (std::uint64_t n = 1; n <= 1500; ++n) {
    input.tick = n;
    input.device = test::sample_at(1e-3, static_cast<std::int64_t>(n) * 1000000, n);
    const HapticSnapshot& out = haptics.tick(input);
    ARTUS_RUNS_REALTIME(LiveAttempt::on_tick, live.on_tick(out));
    EXPECT_EQ(live.full(), n > 1001) << n;
  }
  EXPECT_NEAR(live.measure().needle.back().time, 1, 0.2);
}

}  // namespace
}  // namespace artus
