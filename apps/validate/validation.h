// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/apps/options/command.h"

namespace artus {

/// The flags of `artus validate`, and what they do.
void add_validation(Command& app, ExitCode& code);

}  // namespace artus
