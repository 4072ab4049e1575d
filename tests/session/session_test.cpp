// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/session.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <thread>

#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/detail/session/hand_device.h"
#include "artus/detail/session/record/dropping_ring.h"
#include "artus/session/replay.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

Session::Options quiet_options() {
  Session::Options options;
  options.haptic_options = {};
  options.imaging_options = {};
  return options;
}

template <class Condition>
bool wait_until(Condition condition) {
  for (int i = 0; i < 2000 && !condition(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

TEST(Session, StartsTicksMakesImagesAndStops) {
  auto session = Session::start(test::make_layered_scene(), test::make_small_session(),
                                test::make_injecting_hand(), quiet_options());
  ASSERT_TRUE(session) << session.error().to_string();
  EXPECT_TRUE(wait_until([&] { return (*session)->ticks() > 200 && (*session)->frames() > 3; }));
  HapticSnapshot now;
  EXPECT_TRUE((*session)->newest(now));
  const ImageSnapshot* image = (*session)->newest_image();
  ASSERT_NE(image, nullptr);
  EXPECT_EQ(image->grey.size(), static_cast<std::size_t>(image->width * image->height));
  EXPECT_GT((*session)->times().haptic_compute.count(), 200U);
}

TEST(Session, WhatTheMachineItselfCostsIsMeasuredBeside) {
  Session::Options options = quiet_options();
  options.images = false;
  options.gauge = true;
  options.floor_seconds = 0.1;
  auto session = Session::start(test::make_layered_scene(), test::make_small_session(),
                                test::make_injecting_hand(), options);
  ASSERT_TRUE(session) << session.error().to_string();
  ASSERT_TRUE(wait_until([&] { return (*session)->ticks() > 50; }));
  const SessionTimes& times = (*session)->times();
  EXPECT_GT(times.haptic_floor.count(), 10U);
  EXPECT_GE(times.haptic_fixed.count(), 49U);
  EXPECT_GT(times.haptic_fixed.percentile_us(0.5), 0.1);
}

TEST(Session, AFrozenImageStaysWhileTheHandGoesOn) {
  auto session = Session::start(test::make_layered_scene(), test::make_small_session(),
                                test::make_injecting_hand(), quiet_options());
  ASSERT_TRUE(wait_until([&] { return (*session)->frames() > 1; }));
  (*session)->set_frozen(true);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const std::uint64_t frames = (*session)->frames();
  const std::uint64_t ticks = (*session)->ticks();
  ASSERT_TRUE(wait_until([&] { return (*session)->ticks() > ticks + 100; }));
  EXPECT_EQ((*session)->frames(), frames);
}

TEST(Session, ARecordedSessionReplaysToTheSameBytes) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("artus-session-" + std::to_string(getpid()) + ".rec");
  const auto scene = test::make_layered_scene();
  const SessionParams params = test::make_small_session();
  {
    Session::Options options = quiet_options();
    options.recording = file;
    auto session = Session::start(scene, params, test::make_injecting_hand(), options);
    ASSERT_TRUE(session) << session.error().to_string();
    ASSERT_TRUE(wait_until([&] { return (*session)->ticks() > 900 && (*session)->frames() > 5; }));
    (*session)->set_paused(true);
    ASSERT_TRUE(wait_until([&] { return (*session)->ticks() > 950; }));
    (*session)->set_paused(false);
    ImageControls controls = controls_of(params);
    controls.gain_db = 6;
    controls.depth = 35e-3;
    (*session)->set_controls(controls);
    (*session)->reset();
    ASSERT_TRUE(
        wait_until([&] { return (*session)->ticks() > 1200 && (*session)->frames() > 24; }));
  }
  const auto recording = read_recording(file);
  ASSERT_TRUE(recording) << recording.error().to_string();
  EXPECT_TRUE(recording->complete);
  EXPECT_EQ(recording->dropped, 0U);
  EXPECT_GT(recording->ticks.size(), 1200U);
  double strongest = 0;
  for (const TickRecord& tick : recording->ticks) strongest = std::min(strongest, tick.force[2]);
  EXPECT_LT(strongest, -0.5) << "the recorded hand must have felt something";
  const auto same = replay(*recording, scene);
  ASSERT_TRUE(same) << same.error().to_string();
  EXPECT_TRUE(same->identical());
  EXPECT_EQ(same->ticks, recording->ticks.size());

  Recording tampered = *recording;
  const auto felt = std::find_if(tampered.ticks.begin(), tampered.ticks.end(),
                                 [](const TickRecord& tick) { return tick.force[2] < -0.3; });
  felt->input.device.X_WN.position[2] += 1e-4;
  tampered.frames.back().input.X_JP.position[0] += 1e-3;
  const auto other = replay(tampered, scene);
  EXPECT_GT(other->different_ticks, 0U);
  EXPECT_EQ(other->different_frames, 1U);
  std::filesystem::remove(file);
}

TEST(Session, ACutOffRecordingGivesWhatThereIs) {
  const auto file =
      std::filesystem::temp_directory_path() / ("artus-cut-" + std::to_string(getpid()) + ".rec");
  const auto scene = test::make_layered_scene();
  {
    auto recorder = Recorder::start(file, make_head(scene->joint(), test::make_small_session()));
    ASSERT_TRUE(recorder);
    for (std::uint64_t i = 1; i <= 10; ++i) {
      TickRecord record;
      record.input.tick = i;
      (*recorder)->add(record);
    }
  }
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 100);
  const auto recording = read_recording(file);
  ASSERT_TRUE(recording) << recording.error().to_string();
  EXPECT_FALSE(recording->complete);
  EXPECT_EQ(recording->ticks.size(), 9U);
  std::filesystem::remove(file);
}

TEST(Session, WithoutImagesNothingIsDrawn) {
  Session::Options options = quiet_options();
  options.images = false;
  auto session = Session::start(test::make_layered_scene(), test::make_small_session(),
                                test::make_injecting_hand(), options);
  ASSERT_TRUE(wait_until([&] { return (*session)->ticks() > 300; }));
  EXPECT_EQ((*session)->frames(), 0U);
  EXPECT_EQ((*session)->times().image_render.count(), 0U);
}

TEST(Session, AFailureOfImagingIsToldAndTheHandGoesOn) {
  std::atomic<int> failures{0};
  Session::Options options = quiet_options();
  options.on_image = [&failures](const ImageSnapshot& image) {
    if (image.input.number == 2 || image.input.number == 4) {
      ++failures;
      throw std::runtime_error("no more ink");
    }
  };
  auto session = Session::start(test::make_layered_scene(), test::make_small_session(),
                                test::make_injecting_hand(), options);
  ASSERT_TRUE(wait_until([&] { return failures == 1; }));
  const std::uint64_t ticks = (*session)->ticks();
  ASSERT_TRUE(wait_until([&] { return (*session)->frames() >= 6; })) << "images come again";
  EXPECT_GT((*session)->ticks(), ticks + 100) << "the hand went on";
  ASSERT_FALSE((*session)->notices().empty());
  EXPECT_NE((*session)->notices().front().find("no more ink"), std::string::npos);
}

/// Sends poses that no device can have.
class BrokenDevice final : public InputDevice {
 public:
  DeviceSample read(std::int64_t now_ns) noexcept override {
    DeviceSample sample = test::sample_at(10e-3, now_ns, ++number_);
    const double nasty[] = {std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity(), 1e300, 0};
    sample.X_WN.position[number_ % 3] = nasty[number_ % 4];
    sample.X_WP.position[(number_ + 1) % 3] = nasty[(number_ + 1) % 4];
    sample.X_WP.rotation[number_ % 4] = nasty[(number_ + 2) % 4];
    return sample;
  }
  void write(const DeviceFeedback& feedback) noexcept override {
    for (const double f : feedback.force)
      if (!std::isfinite(f)) ++wrong_;
  }
  [[nodiscard]] std::string_view name() const noexcept override { return "broken"; }
  std::uint64_t wrong_ = 0;

 private:
  std::uint64_t number_ = 0;
};

TEST(Session, APoseThatIsNoneReachesNeitherSnapshotNorImageNorRecording) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("artus-broken-" + std::to_string(getpid()) + ".rec");
  const auto scene = test::make_layered_scene();
  {
    Session::Options options = quiet_options();
    options.recording = file;
    auto session = Session::start(scene, test::make_small_session(),
                                  std::make_unique<BrokenDevice>(), options);
    ASSERT_TRUE(wait_until([&] { return (*session)->ticks() > 500 && (*session)->frames() > 5; }));
    HapticSnapshot now;
    ASSERT_TRUE((*session)->newest(now));
    for (const PlainPose& pose : {now.X_JN, now.X_JP, now.input.device.X_WN, now.input.device.X_WP})
      EXPECT_TRUE(is_pose(pose));
    EXPECT_TRUE((*session)->notices().empty()) << (*session)->notices().front();
  }
  const auto recording = read_recording(file);
  ASSERT_TRUE(recording) << recording.error().to_string();
  const auto again = replay(*recording, scene);
  EXPECT_TRUE(again->identical());
  std::filesystem::remove(file);
}

TEST(LatencyHistogram, PercentilesAreRightWithinThreePercent) {
  LatencyHistogram histogram;
  for (int i = 1; i <= 100000; ++i) histogram.add(i * 10);
  EXPECT_NEAR(histogram.percentile_us(0.5), 500, 15);
  EXPECT_NEAR(histogram.percentile_us(0.999), 999, 30);
  EXPECT_DOUBLE_EQ(histogram.max_us(), 1000);
}

TEST(LatencyHistogram, ATickThatBlocksOthersCountsForThem) {
  LatencyHistogram histogram;
  histogram.add_with_missed(5'000'000, 1'000'000);
  EXPECT_EQ(histogram.count(), 5U);
}

TEST(NewestMailbox, TheConsumerSeesOnlyWholeAndEverNewerValues) {
  NewestMailbox<std::vector<int>> mailbox;
  EXPECT_EQ(mailbox.newest(), nullptr);
  std::atomic<bool> done{false};
  std::thread producer([&] {
    for (int i = 1; i <= 20000; ++i) {
      mailbox.slot().assign(16, i);
      mailbox.publish();
    }
    done = true;
  });
  int last = 0;
  bool sound = true;
  while (!done || last != 20000) {
    const std::vector<int>* value = mailbox.newest();
    if (value == nullptr) continue;
    sound = sound && value->front() == value->back() && value->front() >= last;
    last = value->front();
  }
  producer.join();
  EXPECT_TRUE(sound);
}

TEST(DroppingRing, KeepsOrderAndCountsWhatItDrops) {
  DroppingRing<int> ring(3);
  EXPECT_TRUE(ring.push(1) && ring.push(2) && ring.push(3));
  EXPECT_FALSE(ring.push(4));
  EXPECT_EQ(ring.dropped(), 1U);
  int value = 0;
  EXPECT_TRUE(ring.pop(value));
  EXPECT_EQ(value, 1);
}

TEST(HandDevice, MovesToItsTargetNoFasterThanAHand) {
  HandTarget start;
  HandDevice device(start, 1e-3);
  HandTarget target = start;
  target.X_WN.position[0] = 0.05;
  device.set_target(target);
  double before = 0;
  double fastest = 0;
  for (int i = 1; i <= 2000; ++i) {
    const DeviceSample sample = device.read(i * 1'000'000);
    fastest = std::max(fastest, sample.X_WN.position[0] - before);
    before = sample.X_WN.position[0];
  }
  EXPECT_NEAR(before, 0.05, 1e-6);
  EXPECT_LE(fastest, 0.08 * 1e-3 * (1 + 1e-9));
}

}  // namespace
}  // namespace artus
