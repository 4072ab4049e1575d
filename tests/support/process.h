// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace artus::test {

struct ProcessResult {
  int exit_code = -1;
  std::string out;  ///< standard output
  std::string err;  ///< standard error
};

/// Runs a program with arguments (no shell expansion of them) and waits for it.
[[nodiscard]] ProcessResult run_process(const std::vector<std::string>& command);

}  // namespace artus::test
