// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/pose_track.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/training/metrics/zero_phase.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

const Eigen::Quaterniond kUpright(1, 0, 0, 0);

TEST(PoseSampler, AStraightRunStaysOnItsLineWhateverTheRate) {
  for (const double rate : {8.0, 33.3, 100.0, 1000.0}) {
    PoseSampler sampler(20);
    for (int i = 0; i / rate <= 10; ++i)
      sampler.add(5 + i / rate, Vec3(0.01 * i / rate, 0, 0), kUpright);
    const auto points = sampler.points();
    ASSERT_GT(points.size(), 900U);
    for (const TrackPoint& p : points) EXPECT_NEAR(p.p.x(), 0.01 * (p.time - 5), 1e-12) << rate;
  }
}

TEST(PoseSampler, PosesOfOneTimeAndGapsAreCrossed) {
  PoseSampler sampler(20);
  sampler.add(0, Vec3::Zero(), kUpright);
  sampler.add(0, Vec3(1e-3, 0, 0), kUpright);
  sampler.add(0.5, Vec3(1e-3, 0, 0), kUpright);
  sampler.add(4.5, Vec3(5e-3, 0, 0), kUpright);
  const auto points = sampler.points();
  ASSERT_EQ(points.size(), 451U);
  EXPECT_NEAR(points[250].p.x(), 3e-3, 1e-12);
  EXPECT_NEAR(points[450].p.x(), 5e-3, 1e-12);
}

TEST(PoseSampler, AQuaternionAndItsNegativeAreOneTurn) {
  PoseSampler sampler(20);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  Eigen::Quaterniond negative = turn;
  negative.coeffs() = -turn.coeffs();
  for (int i = 0; i <= 100; ++i) sampler.add(0.01 * i, Vec3::Zero(), i % 2 == 0 ? turn : negative);
  for (const TrackPoint& p : sampler.points()) EXPECT_LT(p.q.angularDistance(turn), 1e-9);
}

TEST(PoseSampler, TakesNoMemoryInTheTick) {
  PoseSampler sampler(0.5);
  ARTUS_RUNS_REALTIME(PoseSampler::add, for (int i = 0; i < 2000; ++i)
                                            sampler.add(1e-3 * i, Vec3(1e-6 * i, 0, 0), kUpright));
  EXPECT_TRUE(sampler.full());
}

TEST(Smooth, NoiseOfARestingPointWalksTwoPointThreeSigmaAStep) {
  const double sigma = 1e-5;
  const double rate = 1000;
  double walked = 0;
  Vec3 last = Vec3::Zero();
  PoseSampler sampler(60);
  for (std::uint64_t i = 0; i < 60000; ++i) {
    const Vec3 p(sigma * normal_noise(1, 3 * i), sigma * normal_noise(1, 3 * i + 1),
                 sigma * normal_noise(1, 3 * i + 2));
    if (i > 0) walked += (p - last).norm();
    last = p;
    sampler.add(static_cast<double>(i) / rate, p, kUpright);
  }
  EXPECT_NEAR(walked / 60, 2.257 * sigma * rate, 0.01 * 2.257 * sigma * rate);
  double smoothed = 0;
  const auto track = smooth(sampler.points());
  for (std::size_t i = 1; i < track.size(); ++i) smoothed += (track[i].p - track[i - 1].p).norm();
  EXPECT_LT(smoothed, walked / 100);
}

TEST(Smooth, HalvesASineAtItsCornerWithoutDelay) {
  const auto amplitude = [](double frequency) {
    std::vector<TrackPoint> points(1000);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].time = 0.01 * static_cast<double>(i);
      points[i].p.x() = std::sin(2 * 3.141592653589793 * frequency * points[i].time);
    }
    double largest = 0;
    for (const TrackPoint& p : smooth(points))
      if (p.time > 3 && p.time < 7) largest = std::max(largest, std::abs(p.p.x()));
    return largest;
  };
  EXPECT_NEAR(amplitude(0.5), 1, 2e-2);
  EXPECT_LT(amplitude(9), 0.2);
  std::vector<double> step(400, 0.0);
  for (std::size_t i = 200; i < 400; ++i) step[i] = 1;
  filter_zero_phase(make_butterworth(6, 100), 100, step);
  for (std::size_t i = 0; i < 200; ++i) EXPECT_NEAR(step[i] + step[399 - i], 1, 1e-9);
}

TEST(Smooth, KeepsStraightRunsStraightToTheirEnds) {
  std::vector<TrackPoint> points(501);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].time = 0.01 * static_cast<double>(i);
    points[i].p.x() = 0.02 * points[i].time;
  }
  const auto track = smooth(points);
  ASSERT_EQ(track.size(), 101U);
  for (const TrackPoint& p : track) EXPECT_NEAR(p.p.x(), 0.02 * p.time, 1e-9);
}

TEST(ZeroPhase, TheCornerIsHalved) {
  std::vector<double> x(4000);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = std::sin(2 * 3.141592653589793 * 6 * 0.01 * static_cast<double>(i) + 0.3);
  filter_zero_phase(make_butterworth(6, 100), 100, x);
  double largest = 0;
  for (std::size_t i = 1000; i < 3000; ++i) largest = std::max(largest, std::abs(x[i]));
  EXPECT_NEAR(largest, 0.5, 2e-3);
}

}  // namespace
}  // namespace artus
