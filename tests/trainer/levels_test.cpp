// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/trainer/pages.h"

namespace artus {
namespace {

/// Tasks of levels 0, 0, 1, 2, 4 and 4 that nobody tried.
std::vector<OfferedTask> ladder() {
  std::vector<OfferedTask> tasks;
  for (const int level : {0, 0, 1, 2, 4, 4}) {
    OfferedTask task;
    task.scenario.name = "task-" + std::to_string(tasks.size());
    task.scenario.title = task.scenario.name;
    task.scenario.level = level;
    tasks.push_back(std::move(task));
  }
  return tasks;
}

std::string open_of(std::vector<OfferedTask> tasks) {
  unlock_levels(tasks);
  std::string open;
  for (const OfferedTask& task : tasks) open += task.open ? 'o' : '-';
  return open;
}

TEST(Levels, UnlockOneAfterTheOther) {
  auto tasks = ladder();
  EXPECT_EQ(open_of(tasks), "oo----");
  tasks[0].tally = {3, 1, 1, 100, ""};
  EXPECT_EQ(open_of(tasks), "ooo---");
  tasks[2].tally = {1, 1, 1, 100, ""};
  EXPECT_EQ(open_of(tasks), "oooo--");
  tasks[3].tally = {1, 1, 1, 100, ""};
  EXPECT_EQ(open_of(tasks), "oooooo");
}

TEST(Levels, WhatWasTriedStaysOpenAndWhoPassedAHigherOneNeedsNoLower) {
  auto tasks = ladder();
  tasks[4].tally.attempts = 2;
  EXPECT_EQ(open_of(tasks), "oo--o-");
  tasks[4].tally.passes = 1;
  EXPECT_EQ(open_of(tasks), "oooooo");
}

TEST(Levels, ALockedTaskNamesTheOneBeforeItAndATeacherMayOpenIt) {
  auto tasks = ladder();
  tasks[0].tally = {1, 1, 1, 100, ""};
  unlock_levels(tasks);
  EXPECT_EQ(opener_of(tasks, 4), 2U);
  const Page page = make_locked_page(tasks[4].scenario, tasks[2].scenario, Language::english);
  EXPECT_EQ(page.name, "locked");
  EXPECT_EQ(page.lines.front().text,
            "Level 4 is locked: levels open one after the other, and you are at level 1.");
  ASSERT_EQ(page.choices.size(), 2U);
  EXPECT_NE(page.choices[static_cast<std::size_t>(AfterLocked::opener)].name.find("task-2"),
            std::string::npos);
  EXPECT_TRUE(page.may_back);
}

}  // namespace
}  // namespace artus
