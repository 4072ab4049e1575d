// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/noise.h"

#include <cmath>

#include <gtest/gtest.h>

namespace artus {
namespace {

TEST(Noise, UniformHasTheMeanAndVarianceOfTheUnitInterval) {
  constexpr int kCount = 200000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kCount; ++i) {
    const double u = uniform_noise(7, static_cast<std::uint64_t>(i));
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  const double mean = sum / kCount;
  EXPECT_NEAR(mean, 0.5, 0.003);
  EXPECT_NEAR(squares / kCount - mean * mean, 1.0 / 12, 0.001);
}

TEST(Noise, NormalHasUnitVarianceAndGaussianFourthMoment) {
  constexpr int kCount = 200000;
  double sum = 0;
  double squares = 0;
  double fourth = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = normal_noise(3, static_cast<std::uint64_t>(i));
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.01);
  EXPECT_NEAR(squares / kCount, 1, 0.015);
  EXPECT_NEAR(fourth / kCount, 3, 0.12);
}

TEST(Noise, SeedsGiveIndependentStreams) {
  double product = 0;
  for (std::uint64_t i = 0; i < 100000; ++i) product += normal_noise(1, i) * normal_noise(2, i);
  EXPECT_NEAR(product / 100000, 0, 0.015);
}

}  // namespace
}  // namespace artus
