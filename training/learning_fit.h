// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>

namespace artus {

/// How many of those who came to their n-th trial failed at it.
struct TrialCount {
  std::size_t learners = 0;
  std::size_t failures = 0;
};

/// Failure at trial n (from 1): last + (first - last) (1 - rate)^(n-1), [Oliveira2008].
struct LearningFit {
  double first = 0;  ///< share that fails at the first trial
  double last = 0;   ///< share that practice comes down to
  double rate = 0;   ///< of what is left, lost a trial

  [[nodiscard]] double at(std::size_t trial) const;
};

/// The curve under which the counts, one a trial, are most likely; first >= last. Accurate to some
/// 1e-4 in the rates of failure. Requires: a trial that somebody came to. Cost: below 0.1 s for 60
/// trials.
[[nodiscard]] LearningFit fit_learning(std::span<const TrialCount> trials);

}  // namespace artus
