// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/tracking_wall.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/haptics/needle/laws/motion.h"
#include "tests/haptics/needle/tick_builder.h"

namespace artus {
namespace {

using test::AxialTick;
using test::soft;

double force_at(TrackingWall& wall, NeedleTick& tick) {
  return wall.step(tick).force.z();
}

double push_to(TrackingWall& wall, AxialTick& line, double from, double to, double step = 1e-5) {
  double force = 0;
  const int n = static_cast<int>(std::lround(std::abs(to - from) / step));
  for (int i = 1; i <= n; ++i) {
    const double x = from + (to - from) * i / n;
    force = force_at(wall, line.at(x, to > from ? Motion::inward : Motion::outward));
  }
  return force;
}

TEST(TrackingWall, ForceRisesOverTwoMillimetresToOneNewtonAndStaysThere) {
  AxialTick line(soft(1.0));
  TrackingWall wall;
  wall.start(0, 0);
  EXPECT_NEAR(push_to(wall, line, 0, 1e-3), -0.5, 1e-9);
  EXPECT_NEAR(push_to(wall, line, 1e-3, 2e-3), -1.0, 1e-9);
  EXPECT_NEAR(push_to(wall, line, 2e-3, 12e-3), -1.0, 1e-9);
  EXPECT_NEAR(wall.wall(), 10e-3, 1e-9);
}

TEST(TrackingWall, ForceFallsLinearlyToZeroOverTheSettlingTimeAfterAStop) {
  for (const double dt : {1e-3, 5e-4, 1e-4}) {
    AxialTick line(soft(1.0), dt);
    TrackingWall wall({.settling_time = 0.2});
    wall.start(0, 0);
    push_to(wall, line, 0, 10e-3);
    const int n = static_cast<int>(std::lround(0.2 / dt));
    for (int i = 1; i <= n; ++i) {
      const double expected = -(1.0 - static_cast<double>(i) / n);
      ASSERT_NEAR(force_at(wall, line.at(10e-3, Motion::still)), expected, 1e-9) << dt << ' ' << i;
    }
    EXPECT_NEAR(force_at(wall, line.at(10e-3, Motion::still)), 0, 1e-12);
  }
}

TEST(TrackingWall, CutTrackIsFreeAndCuttingResumesPastTheStop) {
  AxialTick line(soft(1.0, 500, 0.0));
  TrackingWall wall({.settling_time = 0.01});
  wall.start(0, 0);
  push_to(wall, line, 0, 10e-3);
  for (int i = 0; i < 20; ++i) force_at(wall, line.at(10e-3, Motion::still));
  EXPECT_NEAR(push_to(wall, line, 10e-3, 4e-3), 0, 1e-12);
  EXPECT_NEAR(push_to(wall, line, 4e-3, 10e-3), 0, 1e-12);
  EXPECT_NEAR(push_to(wall, line, 10e-3, 11e-3), -0.5, 1e-9);
  EXPECT_NEAR(push_to(wall, line, 11e-3, 14e-3), -1.0, 1e-9);
}

TEST(TrackingWall, WithdrawalIsResistedWithTheAttractedForceAndNothingOutside) {
  AxialTick line(soft(1.0, 500, 0.5));
  TrackingWall wall({.settling_time = 0.01});
  wall.start(0, 0);
  push_to(wall, line, 0, 10e-3);
  for (int i = 0; i < 20; ++i) force_at(wall, line.at(10e-3, Motion::still));
  EXPECT_NEAR(push_to(wall, line, 10e-3, 9.5e-3), 0.25, 1e-9);
  EXPECT_NEAR(push_to(wall, line, 9.5e-3, 5e-3), 0.5, 1e-9);
  EXPECT_EQ(push_to(wall, line, 5e-3, -1e-3), 0);
}

TEST(TrackingWall, WeakerLayerIsFeltWithinMillisecondsAndAStrongerOneBuildsUp) {
  const double fall = TrackingWallParams{}.fall_time;
  for (const double dt : {1e-3, 1e-4}) {
    AxialTick line(soft(2.0), dt);
    TrackingWall wall;
    wall.start(0, 0);
    push_to(wall, line, 0, 10e-3);
    line.tick().layer.tissue.cutting_force = 0.7;
    const double speed = 0.01;  // m/s
    const double after = 10e-3 + speed * fall;
    EXPECT_NEAR(push_to(wall, line, 10e-3, after, speed * dt), -0.7 - 1.3 * std::exp(-1), 1e-9);
    EXPECT_NEAR(push_to(wall, line, after, 11e-3, speed * dt), -0.7, 1e-6);
    line.tick().layer.tissue.cutting_force = 1.7;
    EXPECT_NEAR(push_to(wall, line, 11e-3, 12e-3), -1.2, 1e-6);
    EXPECT_NEAR(push_to(wall, line, 12e-3, 13e-3), -1.7, 1e-9);
  }
}

// No edge between rest and motion: a needle a little less still settles a little less.
TEST(TrackingWall, SettlesAtTheShareInWhichTheNeedleIsStill) {
  const auto after_a_stop = [](double stillness, double seconds) {
    AxialTick line(soft(1.0));
    TrackingWall wall;
    wall.start(0, 0);
    double force = push_to(wall, line, 0, 10e-3);
    for (int i = 0; i < static_cast<int>(std::lround(seconds / 1e-3)); ++i) {
      NeedleTick& tick = line.at(10e-3, Motion::still);
      tick.stillness = stillness;
      force = force_at(wall, tick);
    }
    return force;
  };
  EXPECT_NEAR(after_a_stop(1, 0.1), -0.5, 1e-9);
  EXPECT_NEAR(after_a_stop(0, 1), -1, 1e-9);
  double last = after_a_stop(0, 0.15);
  for (int i = 1; i <= 100; ++i) {
    const double force = after_a_stop(0.01 * i, 0.15);
    EXPECT_GE(force, last) << "stiller needles have settled farther";
    EXPECT_NEAR(force, last, 0.03) << i;
    last = force;
  }
}

// A spring of a hand that rests on the needle yields to the fading force: it creeps in, slowly, and
// never jerks: the force only falls.
TEST(TrackingWall, AHandThatYieldsToTheFadingForceCreepsToItsRest) {
  constexpr double kHand = 1000;  // N/m
  constexpr double kDt = 1e-3;
  AxialTick line(soft(2.0), kDt);
  TrackingWall wall;
  MotionDetector motion;
  wall.start(0, 0);
  motion.reset(0, Motion::inward);
  const double meant = 12e-3;
  double x = 0;
  double force = 0;
  double worst_rise = 0;
  double fastest = 0;
  for (int i = 0; i < 4000; ++i) {
    const double want = std::min(meant, 0.02 * i * kDt);
    const double to = want + force / kHand;
    const double before = x;
    x += (to - x) * 0.05;  // the hand's damping, 20 ms
    motion.step(x, kDt);
    NeedleTick& tick = line.at(x, motion.motion());
    tick.stillness = motion.stillness();
    const double now = force_at(wall, tick);
    if (i * kDt > 0.9) {
      worst_rise = std::max(worst_rise, force - now);
      fastest = std::max(fastest, (x - before) / kDt);
    }
    force = now;
  }
  EXPECT_LT(worst_rise, 1e-3) << "N in a tick";
  const double unheld = 2.0 / TrackingWallParams{}.settling_time / kHand;  // m/s, a plain fading
  EXPECT_LT(fastest, 0.5 * unheld);
  EXPECT_NEAR(force, 0, 0.01);
  EXPECT_NEAR(x, meant, 0.05e-3);
}

TEST(TrackingWall, StiffnessChangeKeepsTheForce) {
  AxialTick line(soft(2.0, 500));
  TrackingWall wall;
  wall.start(0, 0);
  const double before = push_to(wall, line, 0, 3e-3);
  line.tick().layer.tissue.wall_stiffness = 2000;
  EXPECT_NEAR(force_at(wall, line.at(3e-3)), before, 1e-9);
  line.tick().layer.tissue.wall_stiffness = 250;
  EXPECT_NEAR(force_at(wall, line.at(3e-3)), before, 1e-9);
}

TEST(TrackingWall, BoneAddsASpringUpToItsForceThatAStopDoesNotRelax) {
  AxialTick line(soft(1.0));
  Haptic bone = soft(4.0, 2000, 0);
  bone.hard = true;
  line.tick().bone.tissue = bone;
  line.tick().bone_depth = 10e-3;
  TrackingWall wall({.settling_time = 0.01});
  wall.start(0, 0);
  push_to(wall, line, 0, 10e-3);
  EXPECT_NEAR(push_to(wall, line, 10e-3, 10.5e-3), -2.0, 1e-9);
  EXPECT_NEAR(push_to(wall, line, 10.5e-3, 13e-3), -4.0, 1e-9);
  double held = 0;
  for (int i = 0; i < 50; ++i) held = force_at(wall, line.at(11e-3, Motion::still));
  EXPECT_NEAR(held, -2.0, 1e-9);
}

// A sampled spring gives on the way back K step^2 / 2 a tick more than it took; the account forbids
// it. Random walks from the skin and back, over layers that change force and stiffness on the way.
TEST(TrackingWall, NeverGivesMoreEnergyThanItTookOverRandomInsertions) {
  for (std::uint64_t history = 0; history < 1000; ++history) {
    AxialTick line(soft(1.0));
    TrackingWall wall;
    wall.start(0, 0);
    double x = 0;
    double force = 0;
    double given = 0;
    double goal = 0;
    for (std::uint64_t i = 0; i < 600; ++i) {
      if (i % 40 == 0) goal = i < 520 ? 6e-3 * uniform_noise(history, i) : -2e-4;
      const double step = 1e-4 * uniform_noise(history + 5000, i);
      const double next = std::abs(goal - x) < step ? goal : x + std::copysign(step, goal - x);
      given += force * (next - x);
      const bool deep = next > 2.5e-3;
      line.tick().layer.tissue = deep ? soft(3.0, 2000, 1.0) : soft(1.0, 400, 0.3);
      const Motion motion = next > x ? Motion::inward : next < x ? Motion::outward : Motion::still;
      force = force_at(wall, line.at(next, motion));
      x = next;
    }
    given += force * (-1e-3 - x);
    EXPECT_LE(given, 0) << "history " << history;
  }
}

TEST(TrackingWall, FollowsTheAxisWhateverItsDirection) {
  const Vec3 axis = Vec3(1, -2, 3).normalized();
  AxialTick line(soft(1.0));
  line.tick().axis = axis;
  TrackingWall wall;
  wall.start(0, 0);
  Vec3 force = Vec3::Zero();
  for (int i = 1; i <= 500; ++i) force = wall.step(line.at(1e-5 * i)).force;
  EXPECT_LT((force + axis).norm(), 1e-9);
}

}  // namespace
}  // namespace artus
