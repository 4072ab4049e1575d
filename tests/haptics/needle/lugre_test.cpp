// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"
#include "artus/detail/haptics/needle/laws/lugre_friction.h"
#include "tests/haptics/needle/tick_builder.h"

namespace artus {
namespace {

// dz/dt = v - sigma0 |v| z / g(v), integrated by Runge-Kutta in steps of 2 us.
class Reference {
 public:
  explicit Reference(const LugreParams& params) : p_(params) {}
  double rate(double bristle, double v) const {
    return v - p_.sigma0 * std::abs(v) * bristle / lugre_level(p_, v);
  }
  template <class V>
  void run(V velocity, double from, double to) {
    const int n = static_cast<int>(std::lround((to - from) / 2e-6));
    const double h = (to - from) / n;
    for (int i = 0; i < n; ++i) {
      const double t = from + i * h;
      const double k1 = rate(z, velocity(t));
      const double k2 = rate(z + 0.5 * h * k1, velocity(t + 0.5 * h));
      const double k3 = rate(z + 0.5 * h * k2, velocity(t + 0.5 * h));
      const double k4 = rate(z + h * k3, velocity(t + h));
      z += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  double z = 0;

 private:
  LugreParams p_;
};

TEST(LugreFriction, AgreesWithAFineReferenceWithinOnePercentForAllPublishedSets) {
  for (const LugreParams& set : lugre_sets()) {
    const auto velocity = [](double t) {
      return 0.01 * std::cos(kTwoPi * 0.5 * t);
    };
    Reference reference(set);
    LugreBristle bristle;
    constexpr double kDt = 1e-3;
    double worst = 0;
    double top = 0;
    for (int i = 0; i < 2000; ++i) {
      const double t = i * kDt;
      const double before = reference.z;
      reference.run(velocity, t, t + kDt);
      const double middle = velocity(t + 0.5 * kDt);
      const double moved =
          0.01 / (kTwoPi * 0.5) * (std::sin(kTwoPi * 0.5 * (t + kDt)) - std::sin(kTwoPi * 0.5 * t));
      const double got = bristle.step(set, moved, middle, kDt, 1e9);
      const double want = set.sigma0 * reference.z + set.sigma1 * (reference.z - before) / kDt +
                          set.sigma2 * middle;
      worst = std::max(worst, std::abs(got - want));
      top = std::max(top, std::abs(want));
    }
    EXPECT_LT(worst, 0.01 * top) << "set of length " << set.length << ", mu_c " << set.mu_c;
  }
}

TEST(LugreFriction, BristleStaysBoundedAtAnySpeedAndStep) {
  const LugreParams p;
  LugreBristle bristle;
  const double bound = std::max(p.mu_c, p.mu_s) / p.sigma0 * (1 + 1e-12);
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const double scale = std::pow(10.0, -7 + 10 * uniform_noise(1, i));
    const double moved = scale * normal_noise(2, i);
    const double dt = std::pow(10.0, -6 + 6 * uniform_noise(3, i));
    const double f = bristle.step(p, moved, moved / dt, dt, 1e-3);
    ASSERT_TRUE(std::isfinite(f));
    ASSERT_LE(std::abs(bristle.deflection(p)), bound);
  }
}

TEST(LugreFriction, SteadyForceIsTheLevelTimesTheNormalForceOfTheShaftInTheLayer) {
  test::AxialTick line(test::soft(2.0));
  LugreFriction friction(1e-3);
  friction.reset(0);
  const double v = 0.01;
  double force = 0;
  double x = 0;
  for (int i = 0; i < 3000; ++i) {
    x += v * 1e-3;
    force = friction.step(line.at(x, Motion::inward, v)).force.z();
  }
  const LugreParams p;
  const double normal = 2.0 * x / p.length;
  EXPECT_NEAR(force, -normal * (lugre_level(p, v) + p.sigma2 * v), 0.01 * normal);
}

TEST(LugreFriction, AShaftDeepInTissueIsNoStifferThanTheLimit) {
  test::AxialTick line(test::soft(5.0));
  LugreFriction friction(1e-3);
  const double depth = 0.03;
  friction.reset(depth);
  static_cast<void>(friction.step(line.at(depth, Motion::still)));
  const LugreParams p;
  ASSERT_GT(5.0 * depth / p.length * p.sigma0, 5 * p.stiffness_limit);
  constexpr double kPush = 1e-6;  // m, far less than the bristle bends
  static_cast<void>(friction.step(line.at(depth + kPush, Motion::still)));
  double force = 0;
  for (int i = 0; i < 20; ++i)  // until the rates have died away
    force = friction.step(line.at(depth + kPush, Motion::still)).force.z();
  EXPECT_NEAR(-force, p.stiffness_limit * kPush, 0.05 * p.stiffness_limit * kPush);
}

// What a fast needle has loaded goes when it stops, |z| <= g(0) / sigma0, alike at any rate.
TEST(LugreFriction, LoadOfANeedleThatStopsFallsToItsLevelInTheRelaxationTime) {
  const LugreParams p;
  for (const double dt : {1e-3, 5e-4, 1e-4}) {
    LugreBristle bristle;
    for (int i = 0; i < 4000; ++i) bristle.advance(p, 1e-5, lugre_level(p, 0.05));
    const double loaded = bristle.load();
    ASSERT_NEAR(loaded, lugre_level(p, 0.05), 1e-6);
    const int n = static_cast<int>(std::lround(p.relaxation_time / dt));
    for (int i = 0; i < n; ++i) bristle.relax(p, 0, dt);
    EXPECT_NEAR(bristle.load(), p.mu_s + (loaded - p.mu_s) * std::exp(-1.0), 1e-9) << dt;
    for (int i = 0; i < 20 * n; ++i) bristle.relax(p, 0, dt);
    EXPECT_NEAR(bristle.load(), p.mu_s, 1e-6) << dt;
  }
}

TEST(LugreFriction, LoadBelowItsLevelStays) {
  const LugreParams p;
  LugreBristle slow;
  slow.advance(p, 1e-6, lugre_level(p, 0.05));
  const double before = slow.load();
  slow.relax(p, 0.05, 1);
  EXPECT_EQ(slow.load(), before);
}

TEST(LugreFriction, OpposesMotionBothWaysAlike) {
  const LugreParams p;
  LugreBristle in;
  LugreBristle out;
  for (int i = 0; i < 200; ++i) {
    const double moved = 1e-5 * std::sin(0.1 * i);
    EXPECT_EQ(in.step(p, moved, moved / 1e-3, 1e-3, 1),
              -out.step(p, -moved, -moved / 1e-3, 1e-3, 1));
  }
}

}  // namespace
}  // namespace artus
