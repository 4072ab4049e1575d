// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/process.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <sys/wait.h>
#include <unistd.h>

namespace artus::test {
namespace {

std::string quoted(const std::string& argument) {
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string slurp(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace

ProcessResult run_process(const std::vector<std::string>& command) {
  char name[] = "/tmp/artus-process-XXXXXX";
  const std::filesystem::path folder = mkdtemp(name);
  std::string line;
  for (const auto& argument : command) line += quoted(argument) + " ";
  line += ">" + (folder / "out").string() + " 2>" + (folder / "err").string();
  const int status = std::system(line.c_str());  // NOLINT(cert-env33-c): quoted, tests only
  ProcessResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.out = slurp(folder / "out");
  result.err = slurp(folder / "err");
  std::filesystem::remove_all(folder);
  return result;
}

}  // namespace artus::test
