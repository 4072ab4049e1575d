// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/provenance.h"

#include <array>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace artus {
namespace {

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", &utc);
  return text.data();
}

/// The first line that a shell's command prints; empty when there is none.
std::string first_line_of(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");  // NOLINT(cert-env33-c): a fixed command
  if (pipe == nullptr) return {};
  std::array<char, 256> line{};
  const bool read = std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr;
  const bool good = pclose(pipe) == 0 && read;
  std::string text = good ? line.data() : "";
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

std::string describe_commit() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string folder = program.parent_path().string();
  if (error || folder.find('\'') != std::string::npos) return "unknown";
  const std::string commit =
      first_line_of("git -C '" + folder + "' describe --always --dirty 2>/dev/null");
  return commit.empty() ? "unknown" : commit;
}

std::string find_processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown";
}

}  // namespace

Provenance find_provenance(const std::string& command) {
#ifdef __clang__
  const std::string compiler = std::string("Clang ") + __clang_version__;
#else
  const std::string compiler = std::string("GCC ") + __VERSION__;
#endif
  return {today(), describe_commit(), command, find_processor(), compiler, ARTUS_BUILD_TYPE};
}

}  // namespace artus
