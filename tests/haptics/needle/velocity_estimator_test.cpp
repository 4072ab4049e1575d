// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/velocity_estimator.h"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

class EstimatorTest : public ::testing::TestWithParam<double> {
 protected:
  [[nodiscard]] double dt() const { return 1 / GetParam(); }
  // The estimate at time `end` of the position x(t).
  template <class X>
  double at(VelocityEstimator& estimator, X x, double end = 1) const {
    estimator.reset(x(0.0));
    double v = 0;
    const long n = std::lround(end / dt());
    for (long i = 1; i <= n; ++i) v = estimator.step(x(static_cast<double>(i) * dt()));
    return v;
  }
};

TEST_P(EstimatorTest, AllAreExactAtConstantSpeed) {
  const auto line = [](double t) {
    return 0.013 * t;
  };
  WindowedDifference window(0.01, dt());
  EXPECT_NEAR(at(window, line), 0.013, 1e-9);
  for (const int order : {1, 2, 3}) {
    TaylorEstimator taylor(order, 0.005, dt());
    EXPECT_NEAR(at(taylor, line), 0.013, 1e-9) << order;
  }
  LevantDifferentiator levant(1, dt());
  EXPECT_NEAR(at(levant, line), 0.013, 1.1 * 2 * dt()) << "chatters by gain * bound * period";
}

TEST_P(EstimatorTest, AWindowLagsByHalfOfIt) {
  const auto parabola = [](double t) {
    return 0.5 * 0.1 * t * t;
  };
  WindowedDifference window(0.01, dt());
  EXPECT_NEAR(at(window, parabola), 0.1 * (1 - 0.005), 1e-9);
}

TEST_P(EstimatorTest, TaylorOfOrderNIsExactOnAPolynomialOfOrderN) {
  const auto parabola = [](double t) {
    return 0.05 * t * t;
  };
  const auto cubic = [](double t) {
    return 0.05 * t * t * t;
  };
  TaylorEstimator second(2, 0.005, dt());
  TaylorEstimator third(3, 0.005, dt());
  EXPECT_NEAR(at(second, parabola), 0.1, 1e-9);
  EXPECT_NEAR(at(third, parabola), 0.1, 1e-9);
  EXPECT_NEAR(at(third, cubic), 0.15, 1e-9);
}

TEST_P(EstimatorTest, LevantFollowsASineWhoseAccelerationItsBoundCovers) {
  const auto sine = [](double t) {
    return 0.01 * std::sin(kTwoPi * t);
  };
  const double most = 0.01 * kTwoPi * kTwoPi;  // m/s^2
  LevantDifferentiator levant(2 * most, dt());
  levant.reset(0);
  double worst = 0;
  for (long i = 1; i <= std::lround(2 / dt()); ++i) {
    const double t = static_cast<double>(i) * dt();
    const double v = levant.step(sine(t));
    if (t > 1) worst = std::max(worst, std::abs(v - 0.01 * kTwoPi * std::cos(kTwoPi * t)));
  }
  EXPECT_LT(worst, 8 * most * dt()) << "of the order of one period's change";
}

INSTANTIATE_TEST_SUITE_P(Rates, EstimatorTest, ::testing::Values(1000.0, 2000.0, 10000.0));

}  // namespace
}  // namespace artus
