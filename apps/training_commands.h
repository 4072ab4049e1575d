// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/apps/command.h"

namespace artus {

void add_assess_command(Command& app, ExitCode& code);
void add_learners_command(Command& app, ExitCode& code);
void add_play_command(Command& app, ExitCode& code);
void add_rate_command(Command& app, ExitCode& code);
void add_scenario_command(Command& app, ExitCode& code);
void add_train_command(Command& app, ExitCode& code);

}  // namespace artus
