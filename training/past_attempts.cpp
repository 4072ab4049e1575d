// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/past_attempts.h"

#include <algorithm>
#include <ctime>
#include <map>
#include <optional>
#include <utility>

namespace artus {

namespace {

std::optional<std::time_t> time_of(const std::string& utc) {
  std::tm parts{};
  if (strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts) == nullptr) return std::nullopt;
  return timegm(&parts);
}

}  // namespace

Result<std::vector<PastAttempt>> read_past_attempts(Records& records,
                                                    const AttemptRecord& attempt) {
  constexpr double kWeek = 7 * 24 * 3600;  // s
  AttemptFilter who;
  who.person = attempt.person;
  const auto now = time_of(attempt.started);
  const auto attempts = records.attempts(who);
  ARTUS_TRY(attempts);
  const auto values = records.metrics(who);
  ARTUS_TRY(values);
  std::map<std::string, std::vector<Metric>> numbers;
  for (const MetricValue& v : *values)
    numbers[v.attempt].push_back({v.name, v.role, v.unit, v.value, {}, {}});
  std::vector<PastAttempt> out;
  for (const AttemptRecord& a : *attempts) {
    if (a.id == attempt.id) break;  // they come by their start
    const auto began = time_of(a.started);
    if (a.ended.empty() || a.aided || !began || !now || *began > *now) continue;
    out.push_back(past_attempt(std::difftime(*now, *began) / kWeek, numbers[a.id]));
  }
  return out;
}

}  // namespace artus
