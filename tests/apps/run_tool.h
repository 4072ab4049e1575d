// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace artus::test {

/// The compiled simple shoulder of this build.
inline const std::string kSimple = artus::test::test_joints().string() + "/simple-shoulder.artus";

/// Runs this build's tool with arguments and waits for it.
[[nodiscard]] inline ProcessResult artus(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{ARTUS_TOOL};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_process(command);
}

}  // namespace artus::test
