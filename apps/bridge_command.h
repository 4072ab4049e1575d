// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/apps/options/command.h"

namespace artus {

/// Becomes the program of a maker's bridge: `list`, `check MAKER[:NAME]`, `limits MAKER`, or
/// `MAKER[:NAME]=needle|probe ...` with the program's own flags. Returns only where it cannot, and
/// after `list`.
[[nodiscard]] ExitCode run_bridge(const std::vector<std::string>& arguments);

}  // namespace artus
