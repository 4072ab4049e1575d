// SPDX-License-Identifier: AGPL-3.0-or-later
// Knobs of a running session: which image shows them, whatever the threads do meanwhile.
#include "artus/detail/simulation/image_core.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/session/session_support.h"

namespace artus {
namespace {

FrameInput input_at(const ImageControls& controls, std::uint64_t number) {
  FrameInput input;
  input.X_JP = to_plain(
      make_pose(Vec3(1e-4 * static_cast<double>(number), 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  input.X_JN = to_plain(make_pose(Vec3(0, 0, 8e-3), Vec3(0.4, 0, 1), Vec3::UnitX()));
  input.controls = controls;
  input.number = number;
  input.has_needle = 1;
  input.has_probe = 1;
  return input;
}

/// What a renderer that never had other controls shows.
std::uint64_t digest_of_fresh(SessionParams params, const FrameInput& input) {
  params.image.depth = input.controls.depth;
  params.image.gain_db = input.controls.gain_db;
  params.transducer.frequency = input.controls.frequency;
  ImageCore core(test::make_layered_scene(), params);
  return digest_of(core.render(input));
}

class Knobs : public testing::Test {
 protected:
  SessionParams params_ = test::make_small_session();
  ImageControls controls_ = controls_of(params_);
  ImageCore core_{test::make_layered_scene(), params_};
};

TEST_F(Knobs, GainShowsInTheNextImage) {
  core_.render(input_at(controls_, 1));
  controls_.gain_db += 12;
  const FrameInput input = input_at(controls_, 2);
  EXPECT_EQ(digest_of(core_.render(input)), digest_of_fresh(params_, input));
}

TEST(MotionOfImages, APushedNeedleIsBlueARestingOneIsNotSeenAndTheGreysStayTheSame) {
  SessionParams params = test::make_small_session();
  params.image.look = Look::raw;  // on screens a needle of 20 degrees is no brighter than tissue
  params.image.doppler = true;
  params.image.doppler_limit = 0.05;
  ImageCore core(test::make_layered_scene(), params);
  ImageCore plain(test::make_layered_scene(), params);
  const auto pushed_to = [&](double z, std::uint64_t number) {
    FrameInput input = input_at(controls_of(params), number);
    const Vec3 axis = Vec3(1, 0, 0.35).normalized();  // flat: it returns a strong echo
    input.X_JN = to_plain(make_pose(z * axis, axis, Vec3::UnitX()));
    input.X_JP = to_plain(make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
    input.sample_time_ns = static_cast<std::int64_t>(number) * 33'000'000;
    const std::uint64_t greys = digest_of(plain.render(input));
    input.controls.motion = MotionShown::velocity;
    EXPECT_EQ(digest_of(core.render(input)), greys) << number;
    const std::vector<std::uint8_t> motion = core.motion();
    return std::pair(
        std::count_if(motion.begin(), motion.end(), [](int m) { return m > 0 && m < 128; }),
        std::count_if(motion.begin(), motion.end(), [](int m) { return m >= 128; }));
  };
  EXPECT_EQ(pushed_to(20e-3, 1), std::pair(0L, 0L)) << "nothing is known of the first image";
  const auto pushed = pushed_to(21e-3, 2);  // 30 mm/s
  EXPECT_GT(pushed.first, 20);
  EXPECT_EQ(pushed.second, 0);
  EXPECT_EQ(pushed_to(21e-3, 3), std::pair(0L, 0L)) << "it rests";
  const auto pulled = pushed_to(20e-3, 4);
  EXPECT_EQ(pulled.first, 0);
  EXPECT_GT(pulled.second, 20);
  EXPECT_TRUE(plain.motion().empty());
}

TEST_F(Knobs, DepthShowsAFixedNumberOfImagesLaterAndNoneIsMissing) {
  const double before = params_.image.depth;
  controls_.depth = 30e-3;
  const std::uint64_t change = core_.images_to_change();
  ASSERT_EQ(change, 9U);  // 0.3 s at 30 Hz
  for (std::uint64_t k = 0; k < change; ++k) {
    const Frame& frame = core_.render(input_at(controls_, k));
    ASSERT_DOUBLE_EQ(frame.sample_depth * frame.n_samples, before) << k;
    ASSERT_EQ(frame.status, FrameStatus::kOk);
  }
  const FrameInput input = input_at(controls_, change);
  EXPECT_EQ(digest_of(core_.render(input)), digest_of_fresh(params_, input));
}

TEST_F(Knobs, GainGoesOnWhileTablesAreMade) {
  controls_.frequency = 9e6;
  core_.render(input_at(controls_, 1));
  controls_.gain_db -= 10;
  const FrameInput input = input_at(controls_, 2);
  FrameInput unchanged = input;
  unchanged.controls.frequency = params_.transducer.frequency;
  EXPECT_EQ(digest_of(core_.render(input)), digest_of_fresh(params_, unchanged));
  const std::uint64_t change = core_.images_to_change();
  for (std::uint64_t k = 2; k < change; ++k) core_.render(input_at(controls_, k));
  EXPECT_EQ(digest_of(core_.render(input)), digest_of_fresh(params_, input));
}

TEST_F(Knobs, ASliderThatIsDraggedIsFollowedToItsEnd) {
  const std::uint64_t change = core_.images_to_change();
  int depths = 0;
  double shown = params_.image.depth;
  for (std::uint64_t k = 0; k < 4 * change; ++k) {
    if (k < 2 * change) controls_.depth = params_.image.depth - 1e-4 * static_cast<double>(k + 1);
    const Frame& frame = core_.render(input_at(controls_, k));
    const double depth = frame.sample_depth * frame.n_samples;
    if (depth != shown) ++depths;
    shown = depth;
  }
  EXPECT_EQ(depths, 3);  // on the way, and where it stopped
  EXPECT_DOUBLE_EQ(shown, controls_.depth);
}

TEST_F(Knobs, WhatCannotBeSetIsLeftAsItWas) {
  core_.render(input_at(controls_, 1));
  ImageControls wrong = controls_;
  wrong.depth = -1;
  for (std::uint64_t k = 0; k < 12; ++k) core_.render(input_at(wrong, 2 + k));
  EXPECT_EQ(digest_of(core_.render(input_at(wrong, 2))),
            digest_of_fresh(params_, input_at(controls_, 2)));
}

TEST_F(Knobs, TheSameInputsGiveTheSameImagesHoweverFastTheThreadsAre) {
  const auto digests = [this](bool slow) {
    ImageCore core(test::make_layered_scene(), params_);
    ImageControls controls = controls_of(params_);
    std::vector<std::uint64_t> all;
    for (std::uint64_t k = 0; k < 30; ++k) {
      if (k % 4 == 1) controls.depth -= 0.5e-3;
      if (k % 7 == 2) controls.elevation_focus += 1e-3;
      if (slow) std::this_thread::sleep_for(std::chrono::milliseconds(15));
      all.push_back(digest_of(core.render(input_at(controls, k))));
    }
    return all;
  };
  EXPECT_EQ(digests(false), digests(true));
}

}  // namespace
}  // namespace artus
