// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <set>
#include <string>
#include <vector>

#include "artus/detail/trainer/attempt.h"
#include "artus/detail/trainer/bodies.h"
#include "artus/detail/viewer/pages/page.h"

namespace artus {

/// A learner and what they did, for the page that asks who is there.
struct KnownLearner {
  std::string name;
  TrainTally tally;
};
/// Who: the learners, those who came last first, then someone new.
[[nodiscard]] Page make_who_page(const std::vector<KnownLearner>& learners, Language language);
/// The pseudonym of someone new.
[[nodiscard]] Page make_welcome_page(const std::string& person, Language language);

/// A scenario and what the learner did of it.
struct OfferedTask {
  Scenario scenario;
  TrainTally tally;
  bool open = true;  ///< its level is unlocked
};
/// Which tasks are open: those of the lowest level, those of a level after one of which a task was
/// passed, and whatever was tried before. Requires: by level.
void unlock_levels(std::vector<OfferedTask>& tasks);
/// The task that comes before a locked one: the first of the highest open level below it that was
/// not passed. Requires: one that is not open.
[[nodiscard]] std::size_t opener_of(const std::vector<OfferedTask>& tasks, std::size_t locked);
/// Why a task is locked: to `opener`, which opens it, or on all the same.
enum class AfterLocked { opener, all_the_same };
[[nodiscard]] Page make_locked_page(const Scenario& locked, const Scenario& opener,
                                    Language language);
/// What: the scenarios by level, with picture and what was done, and after them the way to earlier
/// attempts when there are any; `at`: the one that is marked.
[[nodiscard]] Page make_what_page(const std::vector<OfferedTask>& tasks, const std::string& person,
                                  TrainBodies& bodies, std::size_t at, Language language);

/// A finished attempt with the title of its task.
struct EarlierAttempt {
  AttemptRecord record;
  std::string title;
};
/// Which attempt to look at again.
[[nodiscard]] Page make_earlier_page(const std::vector<EarlierAttempt>& attempts,
                                     Language language);

/// What a choice of the briefing asks for.
struct BriefingChoice {
  enum class Kind { ask, begin_aided, begin, learn } kind = Kind::begin;
  std::string step;  ///< of ask
};
[[nodiscard]] std::vector<BriefingChoice> briefing_choices(const Scenario& scenario);
/// What it is about, and the questions to the patient; `scenario` with its aids as they would be.
[[nodiscard]] Page make_briefing_page(const Scenario& scenario, const std::set<std::string>& asked,
                                      const std::string& side,
                                      const std::shared_ptr<const PagePicture>& picture,
                                      const KeyMap& keys, Language language);

/// What can be done after an attempt, in the page's order.
enum class AfterAttempt { review, again, next, other, who, report, leave };
/// How it went; `next`: title of the task that follows.
[[nodiscard]] Page make_end_page(const TrainOutcome& outcome, const std::string& next,
                                 Language language);

/// "Wait": until `done`.
[[nodiscard]] Page make_busy_page(const char* what, std::function<bool()> done, Language language);
/// The same while a body is made: with a bar, and a way to give it up.
[[nodiscard]] Page make_preparing_page(TrainBodies& bodies, std::function<bool()> done,
                                       Language language);

}  // namespace artus
