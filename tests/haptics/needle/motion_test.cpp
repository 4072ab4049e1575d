// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

// Stillness at each millisecond on a path that runs at 15 mm/s and comes to rest exponentially.
std::vector<double> stillness_of_a_stop(double rate_hz, double shift) {
  const double dt = 1 / rate_hz;
  MotionDetector detector;
  detector.reset(shift, Motion::inward);
  std::vector<double> out;
  const int per_millisecond = static_cast<int>(rate_hz / 1000);
  for (int i = 1; i <= static_cast<int>(0.5 * rate_hz); ++i) {
    const double t = i * dt;
    const double x =
        shift + (t < 0.2 ? 0.015 * t : 0.003 + 0.015 * 0.03 * (1 - std::exp(-(t - 0.2) / 0.03)));
    detector.step(x, dt);
    if (i % per_millisecond == 0) out.push_back(detector.stillness());
  }
  return out;
}

TEST(MotionDetector, ComesToRestAlikeAtAnyRateAndAnyPlace) {
  const auto reference = stillness_of_a_stop(20000, 0);
  EXPECT_EQ(reference[200], 0);
  EXPECT_EQ(reference[200 + static_cast<int>(2e3 * MotionParams{}.time)], 1);
  for (const double rate : {1000.0, 2000.0, 10000.0}) {
    for (const double shift : {0.0, 13e-6, 57e-6, 99e-6}) {
      const auto stillness = stillness_of_a_stop(rate, shift);
      ASSERT_EQ(stillness.size(), reference.size());
      double off = 0;  // s, the area between the two
      for (std::size_t i = 0; i < stillness.size(); ++i)
        off += std::abs(stillness[i] - reference[i]) * 1e-3;
      EXPECT_LT(off, 3e-3) << rate << " Hz, " << shift;
    }
  }
}

TEST(MotionDetector, StillnessGoesFromOneToZeroBetweenTwoSpeeds) {
  const MotionParams params;
  for (const double share : {0.5, 0.9, 1.25, 1.4, 1.6, 1.75, 2.1, 4.0}) {
    MotionDetector detector;
    detector.reset(0, Motion::inward);
    const double v = share * params.band / params.time;
    for (int i = 1; i <= 5000; ++i) detector.step(v * 1e-4 * i, 1e-4);
    EXPECT_NEAR(detector.stillness(), std::clamp(2 - share, 0.0, 1.0), 0.03) << share;
    EXPECT_EQ(detector.motion(), share < 1.5 ? Motion::still : Motion::inward) << share;
  }
}

// Paths that differ by a micrometre come to rest nearly alike: there is no edge to fall off.
TEST(MotionDetector, StillnessIsAContinuousFunctionOfThePath) {
  MotionParams params;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    MotionDetector a;
    MotionDetector b;
    a.reset(0, Motion::inward);
    b.reset(0, Motion::inward);
    double x = 0;
    for (std::uint64_t i = 0; i < 3000; ++i) {
      x += 6e-6 * uniform_noise(seed, i / 40) * (i / 300 % 2 == 0 ? 1 : -1);
      a.step(x, 1e-3);
      b.step(x + 1e-6 * normal_noise(seed + 100, i), 1e-3);
      ASSERT_NEAR(a.stillness(), b.stillness(), 1e-5 / (params.moving_band - params.band));
    }
  }
}

TEST(MotionDetector, TremorDoesNotWakeARestingNeedle) {
  MotionDetector detector;
  detector.reset(0, Motion::inward);
  int moving = 0;
  for (int i = 0; i < 5000; ++i) {
    const double tremor =
        35e-6 * std::sin(kTwoPi * 9 * 1e-3 * i) + 30e-6 * std::sin(kTwoPi * 11.3e-3 * i);
    detector.step(tremor, 1e-3);
    if (detector.stillness() < 1) ++moving;
  }
  EXPECT_LT(moving, 200) << "only until it first rests";
}

TEST(MotionDetector, DirectionTurnsOnlyBeyondTheBand) {
  MotionDetector detector;
  const double band = MotionParams{}.band;
  const auto after = [&detector](double x) {
    detector.step(x, 1e-3);
    return detector.motion();
  };
  detector.reset(0, Motion::inward);
  for (int i = 1; i <= 100; ++i) detector.step(1e-5 * i, 1e-3);
  EXPECT_EQ(after(1e-3 - 0.9 * band), Motion::inward);
  EXPECT_EQ(after(1e-3 - 1.1 * band), Motion::outward);
  EXPECT_EQ(after(1e-3), Motion::inward) << "back by more than the band";
}

TEST(MotionDetector, ARestingNeedleMovesWhenItLeavesItsPlace) {
  const MotionParams params;
  for (const double distance : {1.0, -1.0}) {
    MotionDetector detector;
    detector.reset(0.02, Motion::still);
    const auto at = [&](double off) {
      detector.step(0.02 + distance * off, 1e-3);
      return detector.stillness();
    };
    EXPECT_EQ(at(0.9 * params.band), 1);
    EXPECT_NEAR(at(0.5 * (params.band + params.moving_band)), 0.5, 1e-9);
    EXPECT_EQ(at(1.1 * params.moving_band), 0);
    EXPECT_EQ(detector.motion(), distance > 0 ? Motion::inward : Motion::outward);
  }
}

TEST(SampleWindow, GivesTheValueAWindowAgoAtAnyRate) {
  for (const double dt : {1e-3, 5e-4, 1e-4}) {
    SampleWindow<double> window(0.01, dt);
    window.reset(0);
    double old = 0;
    for (int i = 1; i * dt <= 0.05; ++i) old = window.push(i * dt);
    EXPECT_NEAR(old, 0.04, dt * 1.01) << dt;
    EXPECT_NEAR(window.duration(dt), 0.01, 1e-12);
  }
}

}  // namespace
}  // namespace artus
