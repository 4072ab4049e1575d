// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "artus/detail/apps/bridge_command.h"
#include "artus/detail/apps/commands.h"
#include "artus/detail/apps/hands_command.h"
#include "artus/detail/apps/options/command.h"
#include "artus/detail/apps/options/old_names.h"
#include "artus/detail/apps/validate_command.h"
#include "artus/detail/core/known_names.h"

namespace {

/// The line that the program takes: without the program's name, old names renamed.
std::vector<std::string> arguments_of(int argc, char** argv) {
  std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  auto renamed = artus::rename_command(arguments);
  if (!renamed) return arguments;
  std::fprintf(stderr, "artus: %s\n", renamed->note.c_str());
  return std::move(renamed->arguments);
}

artus::ExitCode run(const std::vector<std::string>& arguments) {
  using artus::ExitCode;
  if (!arguments.empty() && arguments.front() == "validate")
    return artus::run_validation({arguments.begin() + 1, arguments.end()});
  if (!arguments.empty() && arguments.front() == "bridge")
    return artus::run_bridge({arguments.begin() + 1, arguments.end()});
  if (!arguments.empty() && arguments.front() == "hands")
    return artus::run_hands({arguments.begin() + 1, arguments.end()});
  artus::Command app(
      "artus - anatomy, B-mode echography and needle haptics from one layered model of a joint.\n"
      "Not a medical device.");
  app.set_version_flag("--version", std::string("artus ") + ARTUS_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  artus check humerus.stl                                  what is wrong with a surface\n"
      "  artus compile meshes/simple-shoulder -o simple.artus     surfaces -> compiled joint\n"
      "  artus run three-injections --joint simple.artus --out out/run\n"
      "  artus <command> --help                                   options and examples\n\n"
      "Exit codes: 0 done, 1 it failed (a file, a surface, a claim that does not hold),\n"
      "            2 the command line is wrong, 3 a surface, pose or injection must be mended.");
  ExitCode code = ExitCode::ok;
  artus::add_commands(app, code);
  const std::vector<std::string> names = app.subcommands();
  if (!arguments.empty() && arguments.front().rfind('-', 0) != 0 &&
      std::find(names.begin(), names.end(), arguments.front()) == names.end()) {
    std::fprintf(stderr, "artus: there is no command '%s'%s; artus --help lists them\n",
                 arguments.front().c_str(), artus::did_you_mean(arguments.front(), names).c_str());
    return ExitCode::usage;
  }
  std::vector<const char*> line{"artus"};
  for (const std::string& argument : arguments) line.push_back(argument.c_str());
  return artus::run_commands(app, static_cast<int>(line.size()), line.data(), code);
}

}  // namespace

int main(int argc, char** argv) {
  return artus::run_program([&] { return run(arguments_of(argc, argv)); });
}
