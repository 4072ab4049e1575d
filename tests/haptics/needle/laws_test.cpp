// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/haptics/needle/insertion_cone.h"
#include "artus/detail/haptics/needle/laws/clamping.h"
#include "artus/detail/haptics/needle/laws/classic_cutting.h"
#include "artus/detail/haptics/needle/laws/hard_contact.h"
#include "artus/detail/haptics/needle/laws/orientation_torque.h"
#include "artus/detail/haptics/needle/laws/prepuncture.h"
#include "artus/haptics/device.h"
#include "tests/haptics/needle/tick_builder.h"

namespace artus {
namespace {

using test::AxialTick;
using test::soft;

TEST(ClassicCutting, DirectIsConstantInsideAndZeroOutside) {
  AxialTick line(soft(1.5));
  DirectCutting direct;
  EXPECT_EQ(direct.step(line.at(1e-4)).force.z(), -1.5);
  EXPECT_EQ(direct.step(line.at(0.05)).force.z(), -1.5);
  EXPECT_EQ(direct.step(line.at(-1e-4)).force.z(), 0);
}

TEST(ClassicCutting, SpringGrowsWithDepthAndVoigtAddsSpeed) {
  AxialTick line(soft(1.0, 500));
  SpringCutting spring;
  VoigtCutting voigt({.damping = 4});
  EXPECT_NEAR(spring.step(line.at(6e-3)).force.z(), -3.0, 1e-12);
  EXPECT_NEAR(voigt.step(line.at(6e-3, Motion::inward, 0.05)).force.z(), -3.2, 1e-12);
  EXPECT_EQ(voigt.step(line.at(-1e-6, Motion::inward, 0.05)).force.z(), 0);
}

// a1 d + a2 d^2 with the published millimetre constants: 10 mm give 0.48 + 0.52 N.
TEST(Prepuncture, SimoneOkamuraGivesOneNewtonAtTenMillimetres) {
  LayerHaptics liver{soft(1), CuttingLaw::tracking_wall, PrepunctureLaw::simone_okamura};
  EXPECT_NEAR(prepuncture_force({}, liver, 10e-3, 0), 1.0, 1e-12);
  EXPECT_EQ(prepuncture_force({}, liver, -1e-3, 0), 0);
}

TEST(Prepuncture, BarbeFollowsItsPowerLaw) {
  LayerHaptics skin{soft(1), CuttingLaw::tracking_wall, PrepunctureLaw::barbe};
  const double d = 8e-3;
  EXPECT_NEAR(prepuncture_force({}, skin, d, 0.01), 240 * std::pow(d, 1.3) + 1.5 * d * 0.01, 1e-12);
}

TEST(Prepuncture, MembraneReachesItsPunctureForceAtItsDimple) {
  LayerHaptics skin{soft(1), CuttingLaw::tracking_wall, PrepunctureLaw::membrane};
  skin.tissue.puncture_force = 1.5;
  const PrepunctureParams params;
  EXPECT_NEAR(prepuncture_force(params, skin, params.membrane.dimple, 0), 1.5, 1e-12);
  EXPECT_LT(prepuncture_force(params, skin, 0.5 * params.membrane.dimple, 0), 0.75 + 1e-12);
}

TEST(DecayingSinusoid, StartsAtZeroEndsAtItsDurationAndIsFittedToTheSource) {
  const DecayingSinusoidParams p;
  EXPECT_EQ(decaying_sinusoid(p, 0), 0);
  EXPECT_EQ(decaying_sinusoid(p, 0.055), 0);
  const double quarter = 0.25 / 55;
  EXPECT_NEAR(decaying_sinusoid(p, quarter), 19.9 * std::pow(0.01, quarter / 0.055), 1e-12);
  EXPECT_NEAR(decaying_sinusoid(p, 0.5 / 55), 0, 1e-12);
}

class HardContactTest : public ::testing::Test {
 protected:
  // Peak of |f| while the tip goes through the bone's surface at `speed`.
  static double peak(double speed, double dt, HardLaw law = HardLaw::decaying_sinusoid) {
    AxialTick line(soft(1), dt);
    line.tick().bone_depth = 10e-3;
    HardContactParams params;
    params.law = law;
    HardContact hard(params);
    hard.reset(9e-3);
    double top = 0;
    for (double t = 0; t < 1e-3 / speed + 0.1; t += dt) {
      const double x = std::min(9e-3 + speed * t, 10.2e-3);
      top = std::max(top, std::abs(hard.step(line.at(x, Motion::inward, speed)).force.z()));
    }
    return top;
  }
};

TEST_F(HardContactTest, TapIsProportionalToTheIncomingSpeedAtAnyRate) {
  const double per_speed = peak(0.1, 1e-4) / 0.1;
  for (const double dt : {1e-3, 5e-4, 1e-4}) {
    for (const double speed : {0.01, 0.05, 0.1}) {
      EXPECT_NEAR(peak(speed, dt) / speed, per_speed, 0.02 * per_speed) << dt << ' ' << speed;
    }
  }
}

TEST_F(HardContactTest, ImpulseTurnsTheMomentumRound) {
  AxialTick line(soft(1));
  line.tick().bone_depth = 10e-3;
  HardContactParams params;
  params.law = HardLaw::impulse;
  HardContact hard(params);
  hard.reset(9.99e-3);
  double impulse = 0;
  for (int i = 0; i < 20; ++i) {
    impulse += hard.step(line.at(10.04e-3, Motion::inward, 0.05)).force.z() * 1e-3;
  }
  EXPECT_NEAR(impulse, -2 * params.impulse.mass * 0.05, 1e-12);
}

TEST_F(HardContactTest, FiresOnceUntilTheTipIsOffTheBone) {
  AxialTick line(soft(1));
  line.tick().bone_depth = 10e-3;
  HardContact hard;
  hard.reset(9.9e-3);
  for (int i = 0; i < 100; ++i) hard.step(line.at(10.1e-3, Motion::inward, 0.05));
  EXPECT_EQ(hard.step(line.at(9.8e-3, Motion::outward, -0.05)).force.z(), 0);
  EXPECT_EQ(hard.step(line.at(10.1e-3, Motion::inward, 0.05)).force.z(), 0) << "still the contact";
  hard.step(line.at(9.0e-3, Motion::outward, -0.05));
  hard.step(line.at(10.1e-3, Motion::inward, 0.05));
  EXPECT_NE(hard.step(line.at(10.1e-3, Motion::inward, 0.05)).force.z(), 0) << "a new contact";
}

TEST(Clamping, PullsTheTipToItsLineAndGrowsWithDepth) {
  AxialTick line(soft(1));
  Clamping clamping;
  line.at(17.5e-3).tip += Vec3(1e-3, 0, 0);
  const Vec3 half = clamping.step(line.tick()).force;
  EXPECT_NEAR(half.x(), -0.1, 1e-12);
  EXPECT_NEAR(half.y(), 0, 1e-15);
  line.at(35e-3).tip += Vec3(1e-3, 0, 0);
  EXPECT_NEAR(clamping.step(line.tick()).force.x(), -0.2, 1e-12);
}

// Aside near the skin, in, back on the line, out: the potential 1/2 k(x) e^2 makes the sum zero.
TEST(Clamping, GivesNoEnergyOverAClosedLoop) {
  AxialTick line(soft(1));
  Clamping clamping;
  const Vec3 corners[] = {
      {0, 0, 5e-3}, {2e-3, 0, 5e-3}, {2e-3, 0, 30e-3}, {0, 0, 30e-3}, {0, 0, 5e-3}};
  double work = 0;
  for (int c = 0; c < 4; ++c) {
    constexpr int kSteps = 2000;
    const Vec3 step = (corners[c + 1] - corners[c]) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const Vec3 p = corners[c] + (i + 0.5) * step;
      line.at(p.z()).tip = p;
      work += clamping.step(line.tick()).force.dot(step);
    }
  }
  EXPECT_NEAR(work, 0, 1e-9);
}

TEST(OrientationTorque, ErrorIsTheRotationVectorTheShortWayRound) {
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  const Eigen::Quaterniond q0(Eigen::AngleAxisd(0.7, Vec3(0.2, 1, 0.4).normalized()));
  for (const double angle : {1e-9, 0.3, 3.0}) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis) * q0);
    EXPECT_LT((orientation_error(q, q0) + angle * axis).norm(), 1e-9) << angle;
    const Eigen::Quaterniond other(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_LT((orientation_error(other, q0) + angle * axis).norm(), 1e-9) << angle;
  }
  EXPECT_EQ(orientation_error(q0, q0).norm(), 0);
}

TEST(OrientationTorque, HoldsTheDirectionButLetsTheNeedleSpin) {
  AxialTick line(soft(1));
  OrientationTorque law;
  line.at(35e-3).orientation = Eigen::AngleAxisd(0.1, Vec3::UnitX());
  EXPECT_NEAR(law.step(line.tick()).torque.x(), -0.05, 1e-9);
  line.at(35e-3).orientation = Eigen::AngleAxisd(0.1, Vec3::UnitZ());
  EXPECT_NEAR(law.step(line.tick()).torque.norm(), 0, 1e-12);
}

TEST(InsertionCone, IsFortyFiveDegreesAtTheSkinAndClosesWithDepth) {
  EXPECT_NEAR(insertion_cone(0, 0.035) / kDegree, 45, 1e-12);
  EXPECT_NEAR(insertion_cone(0.035, 0.035), 0, 1e-12);
  EXPECT_NEAR(insertion_cone(0.015, 0.035), std::atan(20.0 / 50), 1e-12);
  for (int i = 1; i <= 35; ++i)
    EXPECT_LT(insertion_cone(1e-3 * i, 0.035), insertion_cone(1e-3 * (i - 1), 0.035));
  EXPECT_EQ(insertion_cone(1, 0.035), 0);
}

TEST(Device, SaturationKeepsTheDirection) {
  const DeviceLimits touch = find_device("touch").value();
  const Wrench out = saturate(touch, {Vec3(6, -3, 2), Vec3(1, 0, 0)});
  EXPECT_NEAR(out.force.norm(), 3.0, 1e-12);
  EXPECT_LT(out.force.cross(Vec3(6, -3, 2)).norm(), 1e-12);
  EXPECT_EQ(out.torque.norm(), 0) << "the Touch has no actuated rotation";
  EXPECT_EQ(saturate(touch, {Vec3(1, 0, 0), Vec3::Zero()}).force, Vec3(1, 0, 0));
  EXPECT_FALSE(find_device("phantom"));
}

}  // namespace
}  // namespace artus
