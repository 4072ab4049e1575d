// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/hands_command.h"

#include <utility>

#include "artus/detail/apps/commands.h"
#include "artus/detail/apps/options/companion_program.h"

namespace artus {

Result<std::filesystem::path> find_hands_program() {
  return find_companion("artus-hands",
                        " was not built or installed beside this program (target artus_hands)");
}

ExitCode run_hands(std::vector<std::string> arguments) {
  const auto program = find_hands_program();
  if (!program) return report_error(program.error(), false);
  arguments.insert(arguments.begin(), "artus hands");
  return become(*program, std::move(arguments));
}

/// For the list of commands: main() hands the line over before it is read.
void add_hands_command(Command& app, ExitCode& code) {
  Command* command = add_command(
      app, "hands", "Hands by a webcam and paper: print, calibrate, run (docs/hands.md)",
      "Examples:\n"
      "  artus hands print -o kit\n"
      "  artus hands run webcam -k hands.toml\n"
      "  artus hands --help");
  on_run(command, code, [] { return run_hands({"--help"}); });
}

}  // namespace artus
