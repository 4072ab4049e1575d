// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/apps/options/window_options.h"

namespace artus {

void add_assess_command(Command& app, ExitCode& code);
void add_learners_command(Command& app, ExitCode& code);
void add_patient_command(Command& app, ExitCode& code);
void add_play_command(Command& app, ExitCode& code);
void add_rate_command(Command& app, ExitCode& code);
void add_scenario_command(Command& app, ExitCode& code);
void add_train_command(Command& app, ExitCode& code);

/// `artus train` as it is without flags, in a window like another one. `language`: as its flag.
[[nodiscard]] ExitCode start_training(const WindowOptions& window, const std::string& language);

}  // namespace artus
