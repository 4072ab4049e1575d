// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/simulated_hand.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/operators/hand_loop.h"
#include "artus/detail/operators/simulated_device.h"

namespace artus {
namespace {

TEST(SimulatedHand, TremorHasItsStrengthAndStaysInItsBand) {
  HandParams params;
  params.tremor_rms = 30e-6;
  const SimulatedHand hand(params);
  constexpr int kSamples = 60000;
  constexpr double kDt = 1e-3;
  double square = 0;
  double in_band = 0;
  double all = 0;
  for (int i = 0; i < kSamples; ++i) square += hand.tremor(i * kDt).squaredNorm();
  EXPECT_NEAR(std::sqrt(square / kSamples / 3), 30e-6, 3e-6);
  for (int f = 2; f < 40; ++f) {
    double re = 0;
    double im = 0;
    for (int i = 0; i < 10000; ++i) {
      const double x = hand.tremor(i * kDt).x();
      re += x * std::cos(6.283185307179586 * f * i * kDt);
      im += x * std::sin(6.283185307179586 * f * i * kDt);
    }
    const double power = re * re + im * im;
    all += power;
    if (f >= 7 && f <= 13) in_band += power;
  }
  EXPECT_GT(in_band / all, 0.9);
}

TEST(SimulatedHand, HandThatLetsGoDoesNothing) {
  const SimulatedHand hand{HandParams{}};
  Intention let_go;
  let_go.grip = false;
  let_go.X_JN.translation() = Vec3(1, 1, 1);
  EXPECT_EQ(hand.wrench(0.3, let_go, {}).force.norm(), 0);
}

TEST(SimulatedDevice, ConstantForceOnAnUndampedMassGivesHalfAccelerationTimesTimeSquared) {
  DeviceLimits device = find_device("ideal").value();
  device.damping = 0;
  SimulatedDevice sim(device, 0.1, 1e-3, Pose::Identity());
  for (int i = 0; i < 10000; ++i) sim.step({}, {Vec3(0.5, 0, 0), Vec3::Zero()}, 1e-5);
  EXPECT_NEAR(sim.motion().X_JN.translation().x(), 0.5 * 0.5 / 0.2 * 0.01, 1e-5);
}

TEST(SimulatedDevice, MotorIsSaturatedAndTheEncoderRounds) {
  const DeviceLimits touch = find_device("touch").value();
  SimulatedDevice strong(touch, 0, 1e-3, Pose::Identity());
  SimulatedDevice limited(touch, 0, 1e-3, Pose::Identity());
  for (int i = 0; i < 100; ++i) {
    strong.step({}, {Vec3(30, 0, 0), Vec3::Zero()}, 1e-5);
    limited.step({}, {Vec3(3, 0, 0), Vec3::Zero()}, 1e-5);
  }
  EXPECT_NEAR(strong.motion().velocity.x(), limited.motion().velocity.x(), 1e-12);
  Pose off = Pose::Identity();
  off.translation().x() = 0.00012;
  const SimulatedDevice rest(touch, 0, 1e-3, off);
  EXPECT_NEAR(rest.measured().translation().x(), 2 * 55e-6, 1e-12);
}

TEST(HandLoop, HandMovesTheNeedleToWhereItWants) {
  HandLoop loop({1000, 20000}, find_device("ideal").value(), HandParams{}, Pose::Identity());
  Intention want;
  want.X_JN.translation() = Vec3(0, 0, 0.01);
  for (int i = 0; i < 1000; ++i) loop.advance({}, [&want](double) { return want; });
  EXPECT_NEAR(loop.motion().X_JN.translation().z(), 0.01, 2e-4);
  EXPECT_EQ(loop.energy_to_hand(), 0);
}

}  // namespace
}  // namespace artus
