// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/apps/options/window_options.h"

namespace artus {

/// `artus train` as it is without flags, in a window like another one. `language`: as its flag.
[[nodiscard]] ExitCode start_training(const WindowOptions& window, const std::string& language);

}  // namespace artus
