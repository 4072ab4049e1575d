// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/logbook.h"

#include <array>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/training/pseudonym.h"

namespace artus {
namespace {

AttemptRecord attempt_at(const char* started, bool passed, bool aided = false) {
  AttemptRecord attempt;
  attempt.scenario = "gel-align";
  attempt.started = started;
  attempt.ended = started;
  attempt.passed = passed;
  attempt.aided = aided;
  return attempt;
}

LogbookTask only_task(const std::vector<AttemptRecord>& attempts, const char* now) {
  const std::array<Scenario, 1> scenarios{*find_scenario("gel-align")};
  return make_logbook(scenarios, attempts, now).front();
}

TEST(Logbook, WhatWasPassedIsDueAgainLaterWithEachDay) {
  EXPECT_EQ(weeks_kept(0), 0);
  EXPECT_EQ(weeks_kept(1), 4);
  EXPECT_EQ(weeks_kept(2), 8);
  EXPECT_EQ(weeks_kept(3), 16);
  EXPECT_EQ(weeks_kept(4), 26);
  EXPECT_EQ(weeks_kept(1000), 26);
  const std::vector<AttemptRecord> once{attempt_at("2026-01-05T10:00:00Z", true)};
  EXPECT_EQ(only_task(once, "2026-01-06T00:00:00Z").due, "2026-02-02T10:00:00Z");
  EXPECT_EQ(only_task(once, "2026-02-02T09:59:59Z").state, LogbookState::held);
  EXPECT_EQ(only_task(once, "2026-02-02T10:00:00Z").state, LogbookState::due);
  const std::vector<AttemptRecord> same_day{attempt_at("2026-01-05T10:00:00Z", true),
                                            attempt_at("2026-01-05T11:00:00Z", true)};
  EXPECT_EQ(only_task(same_day, "2026-01-06T00:00:00Z").due, "2026-02-02T11:00:00Z");
  const std::vector<AttemptRecord> two_days{attempt_at("2026-01-05T10:00:00Z", true),
                                            attempt_at("2026-01-12T10:00:00Z", true)};
  EXPECT_EQ(only_task(two_days, "2026-01-13T00:00:00Z").due, "2026-03-09T10:00:00Z");
}

TEST(Logbook, CountsFinishedAttemptsAndThoseWithoutAids) {
  std::vector<AttemptRecord> attempts{attempt_at("2026-01-05T10:00:00Z", false, true),
                                      attempt_at("2026-01-05T11:00:00Z", false),
                                      attempt_at("2026-01-05T12:00:00Z", false)};
  attempts.back().ended.clear();
  const LogbookTask task = only_task(attempts, "2026-01-06T00:00:00Z");
  EXPECT_EQ(task.attempts, 2);
  EXPECT_EQ(task.unaided, 1);
  EXPECT_EQ(task.state, LogbookState::training);
  EXPECT_EQ(task.due, "");
  EXPECT_EQ(only_task({}, "2026-01-06T00:00:00Z").state, LogbookState::none);
}

TEST(Pseudonym, IsOfNobodyWhoIsThere) {
  std::vector<PersonRecord> taken;
  std::set<std::string> names;
  for (int i = 0; i < 200; ++i) {
    const std::string name = make_pseudonym(taken);
    EXPECT_TRUE(names.insert(name).second) << name;
    taken.push_back({name, "learner", ""});
  }
}

}  // namespace
}  // namespace artus
