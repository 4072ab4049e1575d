// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/smoothness.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace artus {
namespace {

std::vector<double> bell() {
  std::vector<double> v;
  for (int i = 0; i < 200; ++i) v.push_back(std::exp(-5 * std::pow(-1 + 0.01 * i, 2)));
  return v;
}

std::vector<double> minimum_jerk() {
  std::vector<double> v;
  for (int i = 0; i <= 1000; ++i) {
    const double u = i / 1000.0;
    v.push_back(30 * u * u - 60 * u * u * u + 30 * u * u * u * u);
  }
  return v;
}

TEST(Smoothness, ABellHasTheValuesThatItsAuthorsPrint) {
  EXPECT_NEAR(spectral_arc_length(bell(), 100), -1.41403, 5e-6);
  EXPECT_NEAR(log_dimensionless_jerk(bell(), 100), -5.81636, 5e-6);
}

TEST(Smoothness, MinimumJerkIsNearItsClosedForm) {
  EXPECT_NEAR(spectral_arc_length(minimum_jerk(), 1000), -1.40243, 5e-6);
  EXPECT_NEAR(log_dimensionless_jerk(minimum_jerk(), 1000), -5.32003, 5e-6);
  EXPECT_NEAR(log_dimensionless_jerk(minimum_jerk(), 1000), -std::log(720 / (1.875 * 1.875)), 3e-3);
}

TEST(Smoothness, DoesNotDependOnSize) {
  std::vector<double> twice = bell();
  for (double& v : twice) v *= 2;
  EXPECT_NEAR(spectral_arc_length(twice, 100), spectral_arc_length(bell(), 100), 1e-12);
  EXPECT_NEAR(log_dimensionless_jerk(twice, 100), log_dimensionless_jerk(bell(), 100), 1e-12);
}

TEST(Smoothness, TwoMovementsAreLessSmoothThanOne) {
  std::vector<double> two = bell();
  const std::vector<double> one = bell();
  two.insert(two.end(), one.begin(), one.end());
  EXPECT_LT(spectral_arc_length(two, 100), spectral_arc_length(one, 100) - 0.5);
  EXPECT_LT(log_dimensionless_jerk(two, 100), log_dimensionless_jerk(one, 100) - 1);
}

TEST(Smoothness, RestIsZero) {
  const std::vector<double> rest(50, 0.0);
  EXPECT_EQ(spectral_arc_length(rest, 20), 0);
  EXPECT_EQ(log_dimensionless_jerk(rest, 20), 0);
  EXPECT_EQ(spectral_arc_length({}, 20), 0);
  EXPECT_EQ(log_dimensionless_jerk({}, 20), 0);
}

}  // namespace
}  // namespace artus
