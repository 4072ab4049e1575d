// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>

#include "artus/detail/apps/options/command.h"

namespace artus {

/// What every program does around its work: numbers with a point whatever the user's language, and
/// a failure that nothing caught is told in one line. Returns what the process returns.
[[nodiscard]] int run_program(const std::function<ExitCode()>& work) noexcept;

/// Parses the line and runs the chosen command, which keeps its result in `code`.
[[nodiscard]] ExitCode run_commands(Command& app, int argc, const char* const* argv,
                                    const ExitCode& code);

}  // namespace artus
