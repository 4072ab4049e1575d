// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/logbook.h"

#include <algorithm>
#include <ctime>
#include <iomanip>
#include <set>
#include <sstream>

namespace artus {
namespace {

constexpr const char* kUtc = "%Y-%m-%dT%H:%M:%SZ";

/// So many weeks after a moment; empty for what is none.
std::string weeks_after(const std::string& utc, int weeks) {
  constexpr std::time_t kWeek = 7 * 24 * 3600;  // s
  std::tm parts{};
  std::istringstream text(utc);
  text >> std::get_time(&parts, kUtc);
  if (text.fail()) return "";
  const std::time_t time = timegm(&parts) + weeks * kWeek;
  std::tm then{};
  gmtime_r(&time, &then);
  std::ostringstream out;
  out << std::put_time(&then, kUtc);
  return out.str();
}

LogbookState state_of(const LogbookTask& task, const std::string& now) {
  if (task.attempts == 0) return LogbookState::none;
  if (task.passed == 0) return LogbookState::training;
  return task.due <= now ? LogbookState::due : LogbookState::held;
}

}  // namespace

int weeks_kept(int days) noexcept {
  constexpr int kFirst = 4;
  constexpr int kLongest = 26;
  return days <= 0 ? 0 : std::min(kLongest, kFirst << std::min(days - 1, 3));
}

std::vector<LogbookTask> make_logbook(std::span<const Scenario> scenarios,
                                      std::span<const AttemptRecord> attempts,
                                      const std::string& now) {
  constexpr std::size_t kDay = 10;  // "2026-01-31"
  std::vector<LogbookTask> book;
  for (const Scenario& scenario : scenarios) {
    LogbookTask task;
    task.scenario = scenario.name;
    task.procedure = scenario.procedure;
    task.level = scenario.level;
    std::set<std::string> days;
    for (const AttemptRecord& attempt : attempts) {
      if (attempt.scenario != scenario.name || attempt.ended.empty()) continue;
      ++task.attempts;
      task.unaided += attempt.aided ? 0 : 1;
      if (!attempt.passed) continue;
      ++task.passed;
      days.insert(attempt.started.substr(0, kDay));
      if (task.first_pass.empty()) task.first_pass = attempt.started;
      task.first_pass = std::min(task.first_pass, attempt.started);
      task.last_pass = std::max(task.last_pass, attempt.started);
    }
    task.days = static_cast<int>(days.size());
    if (task.passed > 0) task.due = weeks_after(task.last_pass, weeks_kept(task.days));
    task.state = state_of(task, now);
    book.push_back(std::move(task));
  }
  return book;
}

}  // namespace artus
