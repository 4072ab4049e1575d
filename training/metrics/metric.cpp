// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/metric.h"

#include "artus/detail/core/csv.h"

namespace artus {
const Metric* find_metric(std::span<const Metric> metrics, const std::string& name,
                          const std::string& role) noexcept {
  for (const Metric& m : metrics)
    if (m.name == name && (role.empty() || m.role == role)) return &m;
  return nullptr;
}

nlohmann::json to_json(std::span<const Metric> metrics) {
  auto json = nlohmann::json::array();
  for (const Metric& m : metrics)
    json.push_back({{"name", m.name},
                    {"role", m.role},
                    {"unit", m.unit},
                    {"value", m.value ? nlohmann::json(*m.value) : nlohmann::json()},
                    {"definition", m.definition},
                    {"filter", m.rule.filter},
                    {"rate_hz", m.rule.rate}});
  return json;
}

std::vector<Metric> metrics_from_json(const nlohmann::json& json) {
  std::vector<Metric> metrics;
  for (const nlohmann::json& m : json) {
    Metric metric;
    metric.name = m.at("name").get<std::string>();
    metric.role = m.at("role").get<std::string>();
    metric.unit = m.at("unit").get<std::string>();
    if (!m.at("value").is_null()) metric.value = m.at("value").get<double>();
    metric.definition = m.at("definition").get<std::string>();
    metric.rule = {m.at("filter").get<std::string>(), m.at("rate_hz").get<double>()};
    metrics.push_back(std::move(metric));
  }
  return metrics;
}

std::string to_tsv(std::span<const Metric> metrics) {
  std::string out = "MetricName\tMetricRoles\tMetricUnit\tMetricValue\n";
  for (const Metric& m : metrics)
    if (m.value)
      out += m.name + '\t' + m.role + '\t' + m.unit + '\t' + to_exact_csv(*m.value) + '\n';
  return out;
}

std::string to_csv(std::span<const Metric> metrics) {
  std::string out = "metric,role,value,unit,filter,rate_hz,definition\n";
  for (const Metric& m : metrics)
    out += quoted_csv(m.name) + ',' + quoted_csv(m.role) + ',' +
           (m.value ? to_exact_csv(*m.value) : "") + ',' + quoted_csv(m.unit) + ',' +
           quoted_csv(m.rule.filter) + ',' + to_exact_csv(m.rule.rate) + ',' +
           quoted_csv(m.definition) + '\n';
  return out;
}

}  // namespace artus
