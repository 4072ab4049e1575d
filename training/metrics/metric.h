// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace artus {

/// Grows whenever the definition of any metric changes; stands beside every stored value.
inline constexpr int kMetricsVersion = 4;

/// How the poses were prepared from which a number comes.
struct MetricRule {
  std::string filter;  ///< in words
  double rate = 0;     ///< Hz of the values that were summed; 0: as recorded
};

/// One number about an attempt, with all that is needed to defend it.
struct Metric {
  std::string name;             ///< lower_snake, with its unit at the end where it has one
  std::string role;             ///< "needle", "probe", "both", or a structure's name
  std::string unit;             ///< "mm", "s", "count", ...; "-" for shares
  std::optional<double> value;  ///< empty: cannot be said of these data
  std::string definition;       ///< one sentence with its parameters
  MetricRule rule;
};

/// The metric of a name (and role, when given); null when there is none.
[[nodiscard]] const Metric* find_metric(std::span<const Metric> metrics, const std::string& name,
                                        const std::string& role = {}) noexcept;

/// An array of objects with every member; numbers read back to the same bits, null for none.
[[nodiscard]] nlohmann::json to_json(std::span<const Metric> metrics);
/// Back from that. Throws nlohmann::json::exception for what to_json did not write.
[[nodiscard]] std::vector<Metric> metrics_from_json(const nlohmann::json& json);

/// Header MetricName, MetricRoles, MetricUnit, MetricValue and a line a metric, separated by tabs,
/// values with 17 digits; what has no value is left out. The table's form is PerkTutor's.
[[nodiscard]] std::string to_tsv(std::span<const Metric> metrics);
/// metric,role,value,unit,filter,rate_hz,definition with a header; quoted by RFC 4180.
[[nodiscard]] std::string to_csv(std::span<const Metric> metrics);

}  // namespace artus
