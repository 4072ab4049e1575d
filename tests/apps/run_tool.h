// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdlib>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

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

/// Whether windows can be tried here.
[[nodiscard]] inline bool has_virtual_display() {
  // NOLINTNEXTLINE(*-command-processor,*-mt-unsafe): before any thread is started
  return std::system("command -v xvfb-run >/dev/null") == 0;
}

/// Starts this build's tool, silent, and does not wait for it.
[[nodiscard]] inline pid_t start_tool(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), ARTUS_TOOL);
  const pid_t process = fork();
  if (process != 0) return process;
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(ARTUS_TOOL, argv.data());
  _exit(127);
}

}  // namespace artus::test
