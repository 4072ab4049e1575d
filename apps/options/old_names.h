// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace artus {

/// A command line under a command's name of today.
struct RenamedLine {
  std::vector<std::string> arguments;  ///< without the program
  std::string note;                    ///< for people: what the old name is called now
};

/// Names of version 0.1 that still work in 0.2; they go with the next version. Empty when the line
/// begins with none of them.
[[nodiscard]] std::optional<RenamedLine> rename_command(const std::vector<std::string>& arguments);

}  // namespace artus
