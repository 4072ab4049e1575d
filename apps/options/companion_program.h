// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/apps/options/command.h"

namespace artus {

/// A program beside this one, as it is built, or where it is installed. Errors: not_found, with
/// `what_to_do` behind its name.
[[nodiscard]] Result<std::filesystem::path> find_companion(const std::string& program,
                                                           const std::string& what_to_do);

/// Runs it in place of this process; `line` begins with how it names itself. Returns only when that
/// failed, with the reason told.
[[nodiscard]] ExitCode become(const std::filesystem::path& program, std::vector<std::string> line);

}  // namespace artus
