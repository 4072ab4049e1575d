// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/apps/options/command.h"

namespace artus {

/// Becomes the program artus-hands with these arguments. Returns only where it cannot.
[[nodiscard]] ExitCode run_hands(std::vector<std::string> arguments);

/// Where it is. Errors: not_found.
[[nodiscard]] Result<std::filesystem::path> find_hands_program();

}  // namespace artus
