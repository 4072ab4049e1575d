// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/limits.h"

#include <algorithm>

namespace artus {

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

}  // namespace artus
