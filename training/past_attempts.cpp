// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/training/past_attempts.h"

#include <algorithm>
#include <map>
#include <utility>

namespace artus {

Result<std::vector<PastAttempt>> read_past_attempts(Records& records, const std::string& person,
                                                    std::time_t now) {
  constexpr double kWeek = 7 * 24 * 3600;  // s
  AttemptFilter who;
  who.person = person;
  const auto attempts = records.attempts(who);
  ARTUS_TRY(attempts);
  const auto values = records.metrics(who);
  ARTUS_TRY(values);
  std::map<std::string, std::vector<Metric>> numbers;
  for (const MetricValue& v : *values)
    numbers[v.attempt].push_back({v.name, v.role, v.unit, v.value, {}, {}});
  std::vector<PastAttempt> out;
  for (const AttemptRecord& a : *attempts) {
    std::tm began{};
    if (a.ended.empty() || a.aided ||
        strptime(a.started.c_str(), "%Y-%m-%dT%H:%M:%SZ", &began) == nullptr)
      continue;
    const double weeks = std::difftime(now, timegm(&began)) / kWeek;
    out.push_back(past_attempt(std::max(weeks, 0.0), numbers[a.id]));
  }
  return out;
}

}  // namespace artus
