// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/judgement.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "artus/detail/training/metrics/limits.h"

namespace artus {
namespace {

using Relation = Mark::Relation;
constexpr std::array<std::pair<const char*, Relation>, 5> kRelations{
    {{"<=", Relation::at_most},
     {">=", Relation::at_least},
     {"==", Relation::equal},
     {"<", Relation::less},
     {">", Relation::more}}};  // the longer before their beginnings

/// How much of a mark is reached.
double part_of(const Mark& mark, double value) {
  if (holds(mark, value)) return 1;
  const double scale = std::max(std::abs(mark.bound), 1.0);
  const bool upward = mark.relation == Relation::at_least || mark.relation == Relation::more;
  if (upward && mark.bound > 0) return std::clamp(value / mark.bound, 0.0, 1.0);
  return std::clamp(1 - std::abs(value - mark.bound) / scale, 0.0, 1.0);
}

constexpr double kGrave = 3;  // weight of a mark of danger or purpose

double most_of(MarkKind kind) {
  if (kind == MarkKind::fatal) return kFatalScore;
  return kind == MarkKind::danger ? kDangerScore : kFailedScore;
}

}  // namespace

Result<Mark> parse_mark(const std::string& metric, const std::string& text) {
  for (const auto& [sign, relation] : kRelations) {
    const std::string prefix = sign;
    if (text.rfind(prefix, 0) != 0) continue;
    const std::size_t start = text.find_first_not_of(' ', prefix.size());
    const char* end = text.data() + text.size();
    double bound = 0;
    if (start == std::string::npos) break;
    const auto read = std::from_chars(text.data() + start, end, bound);
    if (read.ec != std::errc() || read.ptr != end || !std::isfinite(bound)) break;
    return Mark{metric, relation, bound, text};
  }
  return fail(ErrorCode::malformed,
              "'" + text + "' is not a mark: write <=, <, ==, > or >= and then a number", metric);
}

bool holds(const Mark& mark, double value) noexcept {
  switch (mark.relation) {
    case Relation::less:
      return value < mark.bound;
    case Relation::at_most:
      return value <= mark.bound;
    case Relation::equal:
      return value == mark.bound;
    case Relation::at_least:
      return value >= mark.bound;
    case Relation::more:
      return value > mark.bound;
  }
  return false;
}

int whole_points(double score) noexcept {
  constexpr double kRounding = 1e-9;
  return static_cast<int>(std::floor(score + kRounding));
}

std::vector<Mark> safety_marks() {
  static_assert(kMostPressureKpa == 100, "as it is written below");
  return {{"avoid_fatal", Relation::equal, 0, "== 0"},
          {"avoid_entries", Relation::equal, 0, "== 0"},
          {"withdrawn", Relation::equal, 1, "== 1"},
          {"pressure_peak_kpa", Relation::at_most, kMostPressureKpa, "<= 100"}};
}

MarkKind kind_of_mark(std::string_view metric) noexcept {
  constexpr std::array<std::string_view, 7> kDangers{
      "asked",           "withdrawn", "bone_contacts", "bone_peak_n", "pressure_peak_kpa",
      "aspirated_first", "in_target"};
  constexpr std::array<std::string_view, 6> kPurposes{
      "distance_mm", "found", "given_ml", "given_distance_mm", "unseen_advances", "unseen_mm"};
  const auto among = [&](const auto& names) {
    return std::find(names.begin(), names.end(), metric) != names.end();
  };
  if (metric == "avoid_fatal") return MarkKind::fatal;
  if (metric.substr(0, 6) == "avoid_" || among(kDangers)) return MarkKind::danger;
  return among(kPurposes) ? MarkKind::purpose : MarkKind::style;
}

bool needs_force(std::string_view metric) noexcept {
  constexpr std::array<std::string_view, 4> kForces{"bone_peak_n", "bone_speed_mm_s",
                                                    "plunger_peak_n", "pressure_peak_kpa"};
  return metric.substr(0, 6) == "force_" ||
         std::find(kForces.begin(), kForces.end(), metric) != kForces.end();
}

namespace {

/// Whether something of harm or of the purpose went wrong that fails nobody: bone was met, liquid
/// went astray or was given without aspirating, the needle advanced unseen or ended off the target,
/// where no mark allows it.
bool is_flawed(std::span<const Metric> metrics, std::span<const Mark> marks) {
  const auto beyond = [&](const char* metric, double bound) {
    const bool own = std::any_of(marks.begin(), marks.end(),
                                 [&](const Mark& mark) { return mark.metric == metric; });
    return !own && value_of(metrics, metric) > bound;
  };
  return beyond("bone_contacts", 0) || beyond("distance_mm", kMostOffTargetMm) ||
         unseen_mm(metrics) > kMostUnseenMm || misplaced_ml(metrics) > kMostMisplacedMl ||
         is_unaspirated(metrics);
}

/// A mark against the metrics. Empty: it needs a force that nobody felt.
std::optional<JudgedMark> judge_mark(const Mark& mark, std::span<const Metric> metrics,
                                     std::span<const ScoreWeight> weights, bool felt) {
  if (!felt && needs_force(mark.metric)) return std::nullopt;
  JudgedMark judged;
  judged.mark = mark;
  const Metric* metric = find_metric(metrics, mark.metric);
  if (metric != nullptr) judged.value = metric->value;
  judged.held = judged.value && holds(mark, *judged.value);
  judged.part = judged.value ? part_of(mark, *judged.value) : 0;
  judged.weight = kind_of_mark(mark.metric) == MarkKind::style ? 1 : kGrave;
  for (const ScoreWeight& w : weights)
    if (w.metric == mark.metric) judged.weight = w.weight;
  return judged;
}

}  // namespace

Judgement judge(std::span<const Metric> metrics, std::span<const Mark> marks,
                std::span<const ScoreWeight> weights, bool with_aids, bool felt) {
  Judgement out;
  out.with_aids = with_aids;
  for (const Mark& mark : marks) {
    auto judged = judge_mark(mark, metrics, weights, felt);
    if (judged)
      out.marks.push_back(std::move(*judged));
    else
      out.unjudged.push_back(mark);
  }
  const bool any = !out.marks.empty();
  for (const Mark& mark : safety_marks()) {
    const bool own = mark.metric != "avoid_fatal" &&
                     std::any_of(marks.begin(), marks.end(),
                                 [&](const Mark& other) { return other.metric == mark.metric; });
    auto judged = own ? std::nullopt : judge_mark(mark, metrics, {}, felt);
    const bool listed = std::any_of(out.marks.begin(), out.marks.end(), [&](const auto& other) {
      return other.mark.metric == mark.metric && !other.held;
    });
    if (judged && judged->value && !judged->held && !listed)
      out.marks.push_back(std::move(*judged));
  }
  double most = is_flawed(metrics, marks) ? kFlawedScore : 100;
  double sum = 0;
  double total = 0;
  bool held = any;
  for (const JudgedMark& mark : out.marks) {
    held = held && mark.held;
    if (!mark.held) most = std::min(most, most_of(kind_of_mark(mark.mark.metric)));
    sum += mark.weight * mark.part;
    total += mark.weight;
  }
  out.passed = held && !with_aids;
  out.score = total > 0 ? most * sum / total : 0;
  return out;
}

}  // namespace artus
