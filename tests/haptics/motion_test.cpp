// SPDX-License-Identifier: AGPL-3.0-or-later
#include "haptics/motion.h"

#include <cmath>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kTwoPi = 6.283185307179586;

// When the detector says still on a path that runs at 15 mm/s and comes to rest exponentially.
double time_of_rest(double rate_hz, double shift) {
  const double dt = 1 / rate_hz;
  MotionDetector detector;
  detector.reset(shift, Motion::inward);
  for (int i = 1; i < static_cast<int>(rate_hz); ++i) {
    const double t = i * dt;
    const double x =
        shift + (t < 0.2 ? 0.015 * t : 0.003 + 0.015 * 0.03 * (1 - std::exp(-(t - 0.2) / 0.03)));
    if (detector.step(x, dt) == Motion::still) return t;
  }
  return -1;
}

TEST(MotionDetector, ComesToRestAtTheSameTimeAtAnyRateAndAnyPlace) {
  const double reference = time_of_rest(20000, 0);
  EXPECT_GT(reference, 0.2 + MotionParams{}.time / 2);
  EXPECT_LT(reference, 0.2 + 2 * MotionParams{}.time);
  for (const double rate : {500.0, 1000.0, 2000.0, 10000.0}) {
    for (const double shift : {0.0, 13e-6, 57e-6, 99e-6})
      EXPECT_NEAR(time_of_rest(rate, shift), reference, 4e-3) << rate << " Hz, " << shift;
  }
}

TEST(MotionDetector, IsStillBelowItsSpeedAndMovesAboveIt) {
  const MotionParams params;
  const double eps = params.band / params.time;
  for (const double share : {0.5, 0.9, 1.1, 2.0}) {
    MotionDetector detector;
    detector.reset(0, Motion::inward);
    bool still = false;
    for (int i = 1; i <= 500; ++i)
      still = still || detector.step(share * eps * 1e-3 * i, 1e-3) == Motion::still;
    EXPECT_EQ(still, share < 1) << share;
  }
}

TEST(MotionDetector, TremorDoesNotWakeARestingNeedle) {
  MotionDetector detector;
  detector.reset(0, Motion::inward);
  int moving = 0;
  for (int i = 0; i < 5000; ++i) {
    const double tremor =
        35e-6 * std::sin(kTwoPi * 9 * 1e-3 * i) + 30e-6 * std::sin(kTwoPi * 11.3e-3 * i);
    if (detector.step(tremor, 1e-3) != Motion::still) ++moving;
  }
  EXPECT_LT(moving, 200) << "only until it first rests";
}

TEST(MotionDetector, DirectionTurnsOnlyBeyondTheBand) {
  MotionDetector detector;
  const double band = MotionParams{}.band;
  detector.reset(0, Motion::inward);
  for (int i = 1; i <= 100; ++i) detector.step(1e-5 * i, 1e-3);
  EXPECT_EQ(detector.step(1e-3 - 0.9 * band, 1e-3), Motion::inward);
  EXPECT_EQ(detector.step(1e-3 - 1.1 * band, 1e-3), Motion::outward);
  EXPECT_EQ(detector.step(1e-3, 1e-3), Motion::inward) << "back by more than the band";
}

TEST(MotionDetector, ARestingNeedleMovesWhenItLeavesItsPlace) {
  MotionDetector detector;
  detector.reset(0.02, Motion::still);
  const double wake = MotionParams{}.wake_band;
  EXPECT_EQ(detector.step(0.02 + 0.9 * wake, 1e-3), Motion::still);
  EXPECT_EQ(detector.step(0.02 - 0.9 * wake, 1e-3), Motion::still);
  EXPECT_EQ(detector.step(0.02 - 1.1 * wake, 1e-3), Motion::outward);
}

TEST(MotionDetector, AHandMayFollowTheFadingForceForATimeAfterAStop) {
  const MotionParams params;
  const double follows = 0.9 * params.settling_band;
  ASSERT_GT(follows, params.wake_band);
  const auto stop = [] {
    MotionDetector detector;
    detector.reset(0, Motion::inward);
    while (detector.step(0, 1e-3) != Motion::still) {
    }
    return detector;
  };
  MotionDetector creeping = stop();
  for (int i = 1; i <= 100; ++i) EXPECT_EQ(creeping.step(follows * i / 100, 1e-3), Motion::still);
  for (int i = 0; i < 300; ++i) EXPECT_EQ(creeping.step(follows, 1e-3), Motion::still);
  EXPECT_EQ(creeping.step(follows + 1.1 * params.wake_band, 1e-3), Motion::inward);
  MotionDetector pushed = stop();
  EXPECT_EQ(pushed.step(1.1 * params.settling_band, 1e-3), Motion::inward);
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
