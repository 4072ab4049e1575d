// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>
#include <vector>

#include "artus/detail/training/records.h"
#include "artus/detail/training/scenario.h"

namespace artus {

/// Where someone stands with a task.
enum class LogbookState { none, training, held, due };

/// What someone did of one task, as logbooks of curricula count it.
struct LogbookTask {
  std::string scenario;  ///< name
  std::string procedure;
  int level = 0;
  int attempts = 0;  ///< finished
  int unaided = 0;   ///< of them without aids
  int passed = 0;
  int days = 0;            ///< on which it was passed
  std::string first_pass;  ///< UTC; empty: never
  std::string last_pass;   ///< UTC
  std::string due;         ///< UTC, when it is to be done again; empty: never passed
  LogbookState state = LogbookState::none;
};

/// Weeks after a pass from which the task is to be done again: 4 after the first day on which it
/// was passed, twice as long after each further one, 26 at most (assumed: what was passed on more
/// days is kept longer).
[[nodiscard]] int weeks_kept(int days) noexcept;

/// One person's tasks in the scenarios' order. `now`: UTC, as Records has it. Cost: scenarios times
/// attempts.
[[nodiscard]] std::vector<LogbookTask> make_logbook(std::span<const Scenario> scenarios,
                                                    std::span<const AttemptRecord> attempts,
                                                    const std::string& now);

}  // namespace artus
