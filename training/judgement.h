// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
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
  /// 0 to 100: the parts' weighted mean; of kFlawedScore when something went wrong that fails
  /// nobody, of kFailedScore when a mark did not hold, kDangerScore when it was one of danger,
  /// kFatalScore when what must never be entered was: no failure scores more than a pass.
  double score = 0;
  std::vector<JudgedMark> marks;
  std::vector<Mark> unjudged;  ///< marks that need a force that nobody felt
};

inline constexpr double kFlawedScore = 90;  // assumed, as those below
inline constexpr double kFailedScore = 60;
inline constexpr double kDangerScore = 40;
inline constexpr double kFatalScore = 20;

/// What a mark is about. Danger costs more than style: where a scenario gives no weight of its own,
/// a mark of danger or purpose weighs 3, one of style 1 (assumed).
enum class MarkKind { style, purpose, danger, fatal };
[[nodiscard]] MarkKind kind_of_mark(std::string_view metric) noexcept;

/// Whether a metric comes of a force, a pressure or how hard bone was met, which a hand must feel
/// to hold it: nobody is judged by it whose hands gave no force.
[[nodiscard]] bool needs_force(std::string_view metric) noexcept;

/// Whole points of a score for people: rounded down, so that 100 means that every mark held.
[[nodiscard]] int whole_points(double score) noexcept;

/// A metric's weight in the score.
struct ScoreWeight {
  std::string metric;
  double weight = 1;
};

/// Marks of danger of every task: nothing that is to be spared is entered, the needle is out at the
/// end, the syringe is not forced.
[[nodiscard]] std::vector<Mark> safety_marks();

/// `metrics` against `marks`, and against the marks of safety of every task that `marks` do not set
/// otherwise; of these the missed ones stand among `marks`. `felt`: the hands
/// gave force; else marks that need it are left out and kept as unjudged.
[[nodiscard]] Judgement judge(std::span<const Metric> metrics, std::span<const Mark> marks,
                              std::span<const ScoreWeight> weights, bool with_aids,
                              bool felt = true);

}  // namespace artus
