// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/validate_command.h"

#include <utility>

#include "artus/detail/apps/commands.h"
#include "artus/detail/apps/options/companion_program.h"

namespace artus {
ExitCode run_validation(const std::vector<std::string>& arguments) {
  const auto program = find_companion(
      "artus-validate",
      ", which checks what artus claims, was not built or installed beside this program; build it "
      "with: cmake --build --preset release --target artus_validate");
  if (!program) return report_error(program.error(), false);
  std::vector<std::string> line{"artus validate"};  // as its help names itself
  line.insert(line.end(), arguments.begin(), arguments.end());
  return become(*program, std::move(line));
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
