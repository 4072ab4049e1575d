// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/validate_command.h"

#include <filesystem>
#include <system_error>

#include <unistd.h>

#include "artus/detail/apps/commands.h"

namespace artus {
namespace {

constexpr const char* kProgram = "artus-validate";

/// The program beside this one, as it is built, or where it is installed.
Result<std::filesystem::path> find_program() {
  std::error_code error;
  const auto here = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const auto& file : {here / kProgram, here / "../libexec/artus" / kProgram})
    if (!error && access(file.c_str(), X_OK) == 0) return file;
  return fail(ErrorCode::not_found,
              std::string(kProgram) +
                  ", which checks what artus claims, was not built or installed beside this "
                  "program; build it with: cmake --build --preset release --target artus_validate",
              here.string());
}

}  // namespace

ExitCode run_validation(const std::vector<std::string>& arguments) {
  const auto program = find_program();
  if (!program) return report_error(program.error(), false);
  std::vector<std::string> line{"artus validate"};  // as its help names itself
  line.insert(line.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& argument : line) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(program->c_str(), argv.data());
  const std::error_code why(errno, std::generic_category());
  return report_error({ErrorCode::failed, why.message(), program->string()}, false);
}

/// For the list of commands: main() hands the line over before it is read.
void add_validate_command(Command& app, ExitCode& code) {
  Command* command =
      add_command(app, "validate",
                  "Measure what artus claims against theory and published figures: needle, echo, "
                  "soft, injection, probe",
                  "");
  on_run(command, code, [] { return run_validation({}); });
}

}  // namespace artus
