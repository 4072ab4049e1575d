// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/learning_curve.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <boost/math/special_functions/beta.hpp>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

void require(const FailureRates& rates) {
  ARTUS_REQUIRE(
      rates.acceptable > 0 && rates.unacceptable < 1 && rates.acceptable < rates.unacceptable,
      "rates must be 0 < acceptable < unacceptable < 1");
}

/// A sum that never falls below zero.
Chart run_chart(std::span<const bool> failures, double on_failure, double on_success, double limit,
                bool at_limit) {
  Chart chart;
  double sum = 0;
  for (const bool failed : failures) {
    sum = std::max(0.0, sum + (failed ? on_failure : on_success));
    chart.values.push_back(sum);
    if (!chart.signal && (at_limit ? sum >= limit : sum > limit))
      chart.signal = chart.values.size();
  }
  return chart;
}

}  // namespace

Chart cusum(std::span<const bool> failures, const FailureRates& rates, double limit) {
  require(rates);
  return run_chart(failures, std::log(rates.unacceptable / rates.acceptable),
                   std::log((1 - rates.unacceptable) / (1 - rates.acceptable)), limit, false);
}

SprtLimits sprt_limits(const FailureRates& rates, double alpha, double beta) {
  require(rates);
  ARTUS_REQUIRE(alpha > 0 && beta > 0 && alpha + beta < 1,
                "alpha and beta must be above 0, their sum below 1");
  const double p = std::log(rates.unacceptable / rates.acceptable);
  const double q = std::log((1 - rates.acceptable) / (1 - rates.unacceptable));
  return {q / (p + q), std::log((1 - alpha) / beta) / (p + q),
          std::log((1 - beta) / alpha) / (p + q)};
}

Chart sprt(std::span<const bool> failures, const SprtLimits& limits) {
  Chart chart;
  double sum = 0;
  for (const bool failed : failures) {
    sum += failed ? 1 - limits.step : -limits.step;
    chart.values.push_back(sum);
    if (!chart.signal && (sum <= -limits.acceptable || sum >= limits.unacceptable))
      chart.signal = chart.values.size();
  }
  return chart;
}

Chart lc_cusum(std::span<const bool> failures, const FailureRates& rates, double limit) {
  require(rates);
  return run_chart(failures, std::log(rates.acceptable / rates.unacceptable),
                   std::log((1 - rates.acceptable) / (1 - rates.unacceptable)), limit, true);
}

double lc_cusum_pass_rate(const FailureRates& rates, double limit, double rate,
                          std::size_t trials) {
  require(rates);
  const double good = std::log((1 - rates.acceptable) / (1 - rates.unacceptable));
  const double bad = std::log(rates.acceptable / rates.unacceptable);
  using Since = std::pair<int, int>;  // successes and failures since the sum was last 0
  std::map<Since, double> share{{{0, 0}, 1.0}};
  double passed = 0;
  for (std::size_t i = 0; i < trials; ++i) {
    std::map<Since, double> next;
    for (const auto& [since, of_all] : share) {
      const auto go_on = [&](const Since& to, double chance) {
        const double sum = to.first * good + to.second * bad;
        if (sum >= limit)
          passed += of_all * chance;
        else
          next[sum > 0 ? to : Since{0, 0}] += of_all * chance;
      };
      go_on({since.first + 1, since.second}, 1 - rate);
      go_on({since.first, since.second + 1}, rate);
    }
    share = std::move(next);
  }
  return passed;
}

double FailureBelief::below(double p) const {
  return boost::math::ibeta(1 + failures, 1 + successes, p);
}

FailureBelief believe(std::span<const bool> failures, double memory) {
  FailureBelief belief;
  for (const bool failed : failures) {
    belief.failures = memory * belief.failures + (failed ? 1 : 0);
    belief.successes = memory * belief.successes + (failed ? 0 : 1);
  }
  const double a = 1 + belief.failures;
  const double b = 1 + belief.successes;
  belief.mean = a / (a + b);
  belief.low = boost::math::ibeta_inv(a, b, 0.05);
  belief.high = boost::math::ibeta_inv(a, b, 0.95);
  return belief;
}

std::size_t trials_to_pass(std::size_t failures, double p, double belief) {
  for (std::size_t n = failures;; ++n) {
    const FailureBelief now{static_cast<double>(failures), static_cast<double>(n - failures)};
    if (now.below(p) > belief) return n;
  }
}

}  // namespace artus
