// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/limits.h"

#include <algorithm>

namespace artus {
namespace {

bool has_mark(std::span<const Mark> marks, std::string_view metric) {
  return std::any_of(marks.begin(), marks.end(),
                     [&](const Mark& mark) { return mark.metric == metric; });
}

}  // namespace

std::vector<Mark> safety_marks() {
  return {{"avoid_fatal", Mark::Relation::equal, 0, "== 0"},
          {"avoid_entries", Mark::Relation::equal, 0, "== 0"},
          {"withdrawn", Mark::Relation::equal, 1, "== 1"},
          {"pressure_peak_kpa", Mark::Relation::at_most, kMostPressureKpa, "<= 100"}};
}

double value_of(std::span<const Metric> metrics, const std::string& name) {
  const Metric* metric = find_metric(metrics, name);
  return metric != nullptr ? metric->value.value_or(0) : 0;
}

double misplaced_ml(std::span<const Metric> metrics) {
  const Metric* hit = find_metric(metrics, "in_target");
  return hit != nullptr && hit->value ? value_of(metrics, "given_ml") * (1 - *hit->value) : 0;
}

double unseen_mm(std::span<const Metric> metrics) {
  return std::max(0.0, value_of(metrics, "unseen_mm") - value_of(metrics, "unseen_entry_mm"));
}

bool is_unaspirated(std::span<const Metric> metrics) {
  return value_of(metrics, "given_ml") > kGivenMl && value_of(metrics, "aspirated_first") == 0;
}

bool is_flawed(std::span<const Metric> metrics, std::span<const Mark> marks) {
  const auto beyond = [&](const char* metric, double bound) {
    return !has_mark(marks, metric) && value_of(metrics, metric) > bound;
  };
  return beyond("bone_contacts", 0) || beyond("distance_mm", kMostOffTargetMm) ||
         unseen_mm(metrics) > kMostUnseenMm || misplaced_ml(metrics) > kMostMisplacedMl ||
         is_unaspirated(metrics);
}

}  // namespace artus
