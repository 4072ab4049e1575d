// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/training/metrics/metric.h"

namespace artus {

/// A condition on a metric: "distance_mm" "<= 2".
struct Mark {
  enum class Relation { less, at_most, equal, at_least, more };
  std::string metric;
  Relation relation = Relation::at_most;
  double bound = 0;
  std::string text;  ///< as written: "<= 2"
};

/// Reads "<= 2", "< 2", "== 0", ">= 0.8" or "> 1". Errors: malformed.
[[nodiscard]] Result<Mark> parse_mark(const std::string& metric, const std::string& text);
[[nodiscard]] bool holds(const Mark& mark, double value) noexcept;

/// One mark against an attempt.
struct JudgedMark {
  Mark mark;
  std::optional<double> value;  ///< empty: the attempt does not say, and the mark does not hold
  bool held = false;
  double part = 0;  ///< 0 to 1: 1 where it holds, then falling to 0 at twice as far as allowed
  double weight = 1;
};

/// An attempt judged. Nothing passes while an aid is on.
struct Judgement {
  bool passed = false;
  bool with_aids = false;
  double score = 0;  ///< 0 to 100, the parts' weighted mean
  std::vector<JudgedMark> marks;
};

/// Whole points of a score for people: rounded down, so that 100 means that every mark held.
[[nodiscard]] int whole_points(double score) noexcept;

/// A metric's weight in the score.
struct ScoreWeight {
  std::string metric;
  double weight = 1;
};

[[nodiscard]] Judgement judge(std::span<const Metric> metrics, std::span<const Mark> marks,
                              std::span<const ScoreWeight> weights, bool with_aids);

}  // namespace artus
