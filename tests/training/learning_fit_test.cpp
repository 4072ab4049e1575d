// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/learning_fit.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

/// What a million learners of this curve would show.
std::vector<TrialCount> counts_of(const LearningFit& curve, std::size_t n) {
  std::vector<TrialCount> counts;
  for (std::size_t trial = 1; trial <= n; ++trial)
    counts.push_back({1000000, static_cast<std::size_t>(std::lround(1e6 * curve.at(trial)))});
  return counts;
}

TEST(LearningFit, FindsTheCurveThatManyLearnersFollow) {
  for (const LearningFit& curve :
       {LearningFit{0.7, 0.05, 0.069}, LearningFit{0.9, 0.3, 0.024}, LearningFit{0.4, 0.1, 0.2}}) {
    const LearningFit found = fit_learning(counts_of(curve, 60));
    EXPECT_NEAR(found.first, curve.first, 2e-3);
    EXPECT_NEAR(found.last, curve.last, 4e-3);
    EXPECT_NEAR(found.rate, curve.rate, 1e-3);
  }
}

TEST(LearningFit, FortyLearnersShowTheCurveWithinWhatChanceLeaves) {
  const LearningFit curve{0.7, 0.05, 0.069};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    std::vector<TrialCount> counts(60);
    for (std::size_t trial = 1; trial <= counts.size(); ++trial)
      for (std::uint64_t learner = 0; learner < 40; ++learner) {
        ++counts[trial - 1].learners;
        if (uniform_noise(seed, 1000 * trial + learner) < curve.at(trial))
          ++counts[trial - 1].failures;
      }
    const LearningFit found = fit_learning(counts);
    for (const std::size_t trial : {1U, 10U, 20U, 40U, 60U})
      EXPECT_NEAR(found.at(trial), curve.at(trial), 3 * std::sqrt(0.25 / 40)) << seed << trial;
    EXPECT_NEAR(found.at(20), curve.at(20), 0.06) << seed;
  }
}

TEST(LearningFit, WhoDoesNotLearnHasALevelLine) {
  const LearningFit found = fit_learning(std::vector<TrialCount>(50, {1000, 200}));
  EXPECT_NEAR(found.at(1), 0.2, 1e-2);
  EXPECT_NEAR(found.at(50), 0.2, 1e-2);
  const LearningFit always = fit_learning(std::vector<TrialCount>(20, {10, 0}));
  EXPECT_LT(always.at(1), 1e-3);
  EXPECT_THROW(static_cast<void>(fit_learning(std::vector<TrialCount>(3))), std::invalid_argument);
}

}  // namespace
}  // namespace artus
