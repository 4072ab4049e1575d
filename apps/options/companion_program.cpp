// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/companion_program.h"

#include <cerrno>
#include <system_error>

#include <unistd.h>

namespace artus {

Result<std::filesystem::path> find_companion(const std::string& program,
                                             const std::string& what_to_do) {
  std::error_code error;
  const auto here = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const auto& file : {here / program, here / "../libexec/artus" / program})
    if (!error && access(file.c_str(), X_OK) == 0) return file;
  return fail(ErrorCode::not_found, program + what_to_do, here.string());
}

ExitCode become(const std::filesystem::path& program, std::vector<std::string> line) {
  std::vector<char*> argv;
  for (std::string& argument : line) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  const std::error_code why(errno, std::generic_category());
  return report_error({ErrorCode::failed, why.message(), program.string()}, false);
}

}  // namespace artus
