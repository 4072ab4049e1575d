// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/apps/options/command.h"

namespace artus {

/// What is in a set of shards.
void add_sweep_stats_command(Command& app, ExitCode& code);

}  // namespace artus
