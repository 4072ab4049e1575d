// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "artus/detail/trainer/attempt.h"
#include "artus/detail/trainer/remote_controls.h"
#include "artus/detail/viewer/pages/page.h"

namespace artus {

/// What is already said before the window opens; empty: the window asks.
struct TrainOptions {
  std::string person;
  std::string cohort;           ///< of someone new
  std::string scenario;         ///< a file, or the name of a bundled one
  std::filesystem::path joint;  ///< in place of the scenarios' own
  std::string patient;          ///< in place of theirs
};

/// Shows who, what, briefing, attempt, verdict and review one after the other until someone leaves
/// or the window is closed. `remote`: tasks that another program asks for. Errors: those of the
/// pages, of run_attempt, read_attempt and make_review; not_found (the person).
[[nodiscard]] Result<void> run_training(const TrainOptions& options, const TrainContext& room,
                                        PageOptions pages, std::vector<Scenario> scenarios,
                                        RemoteScenario& remote);

}  // namespace artus
