// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/apps/options/command.h"

namespace artus {

/// Becomes the program artus-validate, with these arguments: what artus claims of itself is
/// measured by a program of its own, so that nobody's tool carries it. Returns when there is none.
[[nodiscard]] ExitCode run_validation(const std::vector<std::string>& arguments);

}  // namespace artus
