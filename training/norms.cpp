// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/norms.h"

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "artus/detail/training/metrics/sight_course.h"

namespace artus {

std::vector<Norm> compute_norms(std::span<const MetricValue> values) {
  struct Sample {
    std::string unit;
    std::vector<double> values;
  };
  std::map<std::pair<std::string, std::string>, Sample> samples;
  for (const MetricValue& v : values) {
    if (!v.value) continue;
    Sample& sample = samples[{v.role, v.name}];
    sample.unit = v.unit;
    sample.values.push_back(*v.value);
  }
  std::vector<Norm> norms;
  for (const auto& [key, sample] : samples) {
    const auto n = static_cast<double>(sample.values.size());
    if (n < kFewestForNorm) continue;
    Norm norm{key.second, key.first, sample.unit, static_cast<int>(n), 0, 0, 0, 0, 0};
    for (const double v : sample.values) norm.mean += v / n;
    for (const double v : sample.values) norm.sd += (v - norm.mean) * (v - norm.mean) / (n - 1);
    norm.sd = std::sqrt(norm.sd);
    norm.p10 = *percentile(sample.values, 0.1);
    norm.p50 = *percentile(sample.values, 0.5);
    norm.p90 = *percentile(sample.values, 0.9);
    norms.push_back(std::move(norm));
  }
  return norms;
}

Result<std::vector<Norm>> renew_norms(Records& records, const std::string& scenario,
                                      const std::string& group) {
  const AttemptFilter filter{"", group, scenario};
  const auto attempts = records.attempts(filter);
  ARTUS_TRY(attempts);
  const std::string hash = attempts->empty() ? "" : attempts->back().scenario_hash;
  std::set<std::string> counted;
  for (const AttemptRecord& a : *attempts)
    if (!a.ended.empty() && !a.aided && a.scenario_hash == hash) counted.insert(a.id);
  if (counted.size() < static_cast<std::size_t>(kFewestForNorm))
    return fail(ErrorCode::invalid, "norms need at least " + std::to_string(kFewestForNorm) +
                                        " finished attempts without aids; the group '" + group +
                                        "' has " + std::to_string(counted.size()) +
                                        " of the newest version of '" + scenario + "'");
  auto values = records.metrics(filter);
  ARTUS_TRY(values);
  std::erase_if(*values, [&](const MetricValue& v) { return counted.count(v.attempt) == 0; });
  std::vector<Norm> norms = compute_norms(*values);
  ARTUS_TRY(records.set_norms(hash, group, norms));
  return norms;
}

}  // namespace artus
