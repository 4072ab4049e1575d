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
[[nodiscard]] inline ProcessResult artus(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), ARTUS_TOOL);
  return run_process(arguments);
}

}  // namespace artus::test
