// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/bridge_command.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <sys/wait.h>
#include <unistd.h>

#include "artus/detail/apps/commands.h"
#include "artus/detail/apps/options/companion_program.h"

namespace artus {
namespace {

constexpr std::array<const char*, 4> kMakers{"touch", "force-dimension", "haply", "virtuose"};
constexpr const char* kUsage =
    "Let a haptic device move and push\n\n"
    "Usage: artus bridge [list | check | limits] [MAKER[:DEVICE[=needle|=probe]] ...] [flags]\n\n";
constexpr const char* kForms =
    "Makers: touch (OpenHaptics), force-dimension (also falcon), haply, and virtuose where it was "
    "built with its SDK. The flags of a maker's "
    "program: artus bridge touch --help (docs/bridges.md)\n"
    "Examples:\n"
    "  artus bridge list\n"
    "  artus bridge touch:NAME=needle touch:OTHER=probe\n"
    "  artus bridge check touch:NAME\n"
    "  artus bridge limits touch > touch.toml\n";

ExitCode become_bridge(const std::string& maker, std::vector<std::string> line) {
  const auto program =
      find_companion("artus-bridge-" + maker, " was not built or installed beside this program");
  if (!program) return report_error(program.error(), false);
  line.insert(line.begin(), "artus bridge " + maker);
  return become(*program, std::move(line));
}

ExitCode list_makers() {
  for (const char* maker : kMakers) {
    const pid_t child = fork();
    if (child == 0) std::exit(static_cast<int>(become_bridge(maker, {"--list"})));
    int status = 0;
    if (child > 0) waitpid(child, &status, 0);
  }
  return ExitCode::ok;
}

/// "touch:A=needle" as touch and A=needle; the maker is empty where there is none of that name.
std::pair<std::string, std::string> parts_of(const std::string& text) {
  const std::size_t end = text.find_first_of(":=");
  std::string maker = text.substr(0, end);
  std::string rest = end == std::string::npos ? "" : text.substr(text[end] == ':' ? end + 1 : end);
  if (maker == "falcon" || maker == "forcedimension") maker = "force-dimension";
  for (const char* known : kMakers)
    if (maker == known) return {maker, rest};
  return {};
}

ExitCode misused(const std::string& what) {
  std::fprintf(stderr, "artus bridge: %s\n%s%s", what.c_str(), kUsage, kForms);
  return ExitCode::usage;
}

}  // namespace

ExitCode run_bridge(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return misused("say which device");
  const std::string& first = arguments.front();
  if (first == "list") return list_makers();
  if (first == "--help" || first == "-h") {
    std::printf("%s%s", kUsage, kForms);
    return ExitCode::ok;
  }
  const bool check = first == "check";
  const bool limits = first == "limits";
  std::string maker;
  std::vector<std::string> line;
  if (check || limits) line.emplace_back(check ? "--check" : "--limits");
  for (std::size_t i = check || limits ? 1 : 0; i < arguments.size(); ++i) {
    const auto [own, device] = parts_of(arguments[i]);
    if (own.empty()) {
      line.push_back(arguments[i]);
      continue;
    }
    if (!maker.empty() && own != maker)
      return misused(
          "devices of two makers are two programs: start one for the needle, one for the "
          "probe");
    maker = own;
    if (device.empty()) continue;
    line.push_back(device.find('=') == std::string::npos ? device + "=needle" : device);
  }
  if (maker.empty()) return misused("'" + first + "' names no maker");
  return become_bridge(maker, std::move(line));
}

/// For the list of commands: main() hands the line over before it is read.
void add_bridge_command(Command& app, ExitCode& code) {
  Command* command = add_command(
      app, "bridge", "Let a haptic device move and push: touch, force-dimension, haply", kForms);
  on_run(command, code, [] { return run_bridge({"--help"}); });
}

}  // namespace artus
