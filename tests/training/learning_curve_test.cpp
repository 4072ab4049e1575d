// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/learning_curve.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

/// Failures at trials 1, 3 and 7 of 21.
std::array<bool, 45> worked_example() {
  std::array<bool, 45> failures{};
  failures[0] = failures[2] = failures[6] = true;
  return failures;
}

TEST(LearningCurve, LcCusumOfTheWorkedExample) {
  const auto x = worked_example();
  const Chart chart = lc_cusum(x, {0.1, 0.2}, 1.5);
  const std::array<double, 8> first{0, 0.118, 0, 0.118, 0.236, 0.353, 0, 0.118};
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(chart.values[i], first[i], 5e-4);
  EXPECT_NEAR(chart.values[14], 0.942, 5e-4);
  EXPECT_NEAR(chart.values[18], 1.413, 5e-4);
  EXPECT_NEAR(chart.values[19], 1.531, 5e-4);
  ASSERT_TRUE(chart.signal);
  EXPECT_EQ(*chart.signal, 20U);
}

TEST(LearningCurve, CusumOfTheWorkedExamplePeaksAtTheSeventhTrial) {
  const auto x = worked_example();
  const Chart chart = cusum(x, {0.1, 0.2}, 2);
  EXPECT_NEAR(chart.values[6], 1.608, 5e-4);
  EXPECT_GT(chart.values[19], 0);
  EXPECT_EQ(chart.values[20], 0);
  EXPECT_FALSE(chart.signal);
}

TEST(LearningCurve, SprtOfTheWorkedExampleCrossesAtTheFortiethTrial) {
  const auto x = worked_example();
  const SprtLimits limits = sprt_limits({0.1, 0.2}, 0.1, 0.1);
  EXPECT_NEAR(limits.step, 0.1452, 5e-5);
  EXPECT_NEAR(limits.acceptable, 2.710, 5e-4);
  EXPECT_NEAR(limits.unacceptable, 2.710, 5e-4);
  const Chart chart = sprt(x, limits);
  EXPECT_NEAR(chart.values[6], 1.983, 5e-4);
  EXPECT_NEAR(chart.values[20], -0.050, 5e-4);
  ASSERT_TRUE(chart.signal);
  EXPECT_EQ(*chart.signal, 40U);
}

TEST(LearningCurve, SprtLimitsOfPublishedPairs) {
  const SprtLimits low = sprt_limits({0.05, 0.1}, 0.1, 0.1);
  EXPECT_NEAR(low.step, 0.0724, 5e-5);
  EXPECT_NEAR(low.acceptable, 2.941, 5e-4);
  const SprtLimits high = sprt_limits({0.2, 0.4}, 0.1, 0.1);
  EXPECT_NEAR(high.step, 0.2933, 5e-5);
  EXPECT_NEAR(high.acceptable, 2.240, 5e-4);
}

TEST(LearningCurve, FalseAndTruePassesOfTheLcCusum) {
  const FailureRates rates{0.1, 0.2};
  struct Row {
    double limit, rate;
    std::size_t trials;
    double share;
  };
  for (const Row& row :
       {Row{1.5, 0.2, 50, 0.48}, Row{1.5, 0.2, 100, 0.78}, Row{2.0, 0.2, 50, 0.24},
        Row{2.0, 0.2, 100, 0.48}, Row{2.5, 0.2, 50, 0.10}, Row{2.5, 0.2, 100, 0.25},
        Row{1.5, 0.1, 50, 0.93}, Row{2.0, 0.1, 50, 0.80}, Row{2.5, 0.1, 50, 0.64}})
    EXPECT_NEAR(lc_cusum_pass_rate(rates, row.limit, row.rate, row.trials), row.share, 0.01)
        << row.limit << ' ' << row.rate << ' ' << row.trials;
}

TEST(LearningCurve, SimulatedLearnersPassAsTheExactDistributionSays) {
  constexpr int kLearners = 20000;
  const FailureRates rates{0.1, 0.2};
  for (const double rate : {0.2, 0.1}) {
    int passed = 0;
    for (int learner = 0; learner < kLearners; ++learner) {
      std::array<bool, 60> x{};
      for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = uniform_noise(11, static_cast<std::uint64_t>(learner) * x.size() + i) < rate;
      passed += lc_cusum(x, rates, 2.5).signal ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(passed) / kLearners, lc_cusum_pass_rate(rates, 2.5, rate, 60),
                0.01)
        << rate;
  }
}

TEST(LearningCurve, AtALimitOfTwoAndAHalfSixtyTrialsPassOneInEightOfTheInadequate) {
  const FailureRates rates{0.1, 0.2};
  EXPECT_NEAR(lc_cusum_pass_rate(rates, 2.5, 0.2, 60), 0.1268, 5e-5);
  EXPECT_NEAR(lc_cusum_pass_rate(rates, 2.5, 0.1, 60), 0.7375, 5e-5);
  EXPECT_LT(lc_cusum_pass_rate(rates, 2.5, 0.2, 57), 0.12);
  EXPECT_GT(lc_cusum_pass_rate(rates, 2.5, 0.2, 58), 0.12);
}

TEST(LearningCurve, TrialsUntilTheBeliefInARatePasses) {
  struct Row {
    double p, belief;
    std::array<std::size_t, 4> trials;
  };
  for (const Row& row : {Row{0.2, 0.9, {10, 17, 24, 31}}, Row{0.2, 0.95, {13, 21, 29, 36}},
                         Row{0.1, 0.9, {21, 37, 51, 64}}})
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_EQ(trials_to_pass(k, row.p, row.belief), row.trials[k]);
}

TEST(LearningCurve, WithoutFailuresTheBeliefHasAClosedForm) {
  for (const double p : {0.05, 0.1, 0.2, 0.3})
    EXPECT_EQ(static_cast<double>(trials_to_pass(0, p, 0.9)),
              std::ceil(std::log(0.1) / std::log(1 - p)) - 1);
}

TEST(LearningCurve, OldFailuresFade) {
  std::array<bool, 40> x{};
  for (std::size_t i = 0; i < 10; ++i) x[i] = true;
  const FailureBelief all = believe(x, 1);
  const FailureBelief recent = believe(x, 0.95);
  EXPECT_NEAR(all.mean, 11.0 / 42, 1e-12);
  EXPECT_LT(recent.mean, all.mean);
  EXPECT_LT(all.low, all.mean);
  EXPECT_GT(all.high, all.mean);
}

TEST(LearningCurve, RatesThatDecideNothingAreRefused) {
  const std::array<bool, 1> x{};
  EXPECT_THROW(static_cast<void>(lc_cusum(x, {0.2, 0.2}, 1)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(cusum(x, {0, 0.2}, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace artus
