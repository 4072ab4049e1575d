// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <vector>

namespace artus {

/// Rates of failure between which a chart decides.
struct FailureRates {
  double acceptable = 0.1;    ///< p0
  double unacceptable = 0.2;  ///< p1 > p0
};

/// One value a trial, and the first trial (from 1) that signals. Outcomes: true is a failure.
struct Chart {
  std::vector<double> values;
  std::optional<std::size_t> signal;
};

/// Has a trained person's performance slipped from p0 to p1? C = max(0, C + W), W = ln(p1/p0) on
/// failure, ln((1-p1)/(1-p0)) on success; signals at C > limit. Source [Biau2007].
[[nodiscard]] Chart cusum(std::span<const bool> failures, const FailureRates& rates, double limit);

/// Sequential probability ratio test as a chart: + 1 - s on failure, - s on success.
struct SprtLimits {
  double step = 0;          ///< s
  double acceptable = 0;    ///< h0: crossed downward at -h0
  double unacceptable = 0;  ///< h1: crossed upward
};
/// `alpha`, `beta`: chances of a wrong "unacceptable" and a wrong "acceptable". Source [Biau2007].
[[nodiscard]] SprtLimits sprt_limits(const FailureRates& rates, double alpha, double beta);
[[nodiscard]] Chart sprt(std::span<const bool> failures, const SprtLimits& limits);

/// Has a learner become adequate? S = max(0, S + W), W = ln((1-p0)/(1-p1)) on success, ln(p0/p1)
/// on failure; signals at S >= limit. Source [BiauPorcher2010].
[[nodiscard]] Chart lc_cusum(std::span<const bool> failures, const FailureRates& rates,
                             double limit);

/// Share of those who always fail at `rate` whom lc_cusum signals within `trials`: the exact
/// distribution of the sum, trial by trial. At rate p1 this is the chance of a false pass, which
/// stands beside every verdict; it is not 1 - alpha of any test. Cost: trials^2 / 10 for usual
/// limits.
[[nodiscard]] double lc_cusum_pass_rate(const FailureRates& rates, double limit, double rate,
                                        std::size_t trials);

/// What is believed of a rate of failure: Beta(1 + failures, 1 + successes) from a flat prior, old
/// trials counted less: weight `memory` per trial since.
struct FailureBelief {
  double failures = 0;
  double successes = 0;
  double mean = 0.5;
  double low = 0.05;  ///< of the 90 % band
  double high = 0.95;
  /// P(rate < p).
  [[nodiscard]] double below(double p) const;
};
[[nodiscard]] FailureBelief believe(std::span<const bool> failures, double memory = 1);

/// Fewest trials with so many failures after which P(rate < p) > `belief` with a flat prior.
[[nodiscard]] std::size_t trials_to_pass(std::size_t failures, double p, double belief);

}  // namespace artus
