// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/bridge_command.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include <sys/wait.h>
#include <unistd.h>

#include "artus/detail/apps/commands.h"

namespace artus {
namespace {

constexpr std::array<const char*, 3> kMakers{"touch", "force-dimension", "haply"};
constexpr const char* kForms =
    "artus bridge list\n"
    "artus bridge touch:NAME=needle touch:OTHER=probe [flags]\n"
    "artus bridge check touch[:NAME]\n"
    "artus bridge limits touch > touch.toml\n"
    "Makers: touch (OpenHaptics), force-dimension (also falcon), haply. The flags of a maker's "
    "program: artus bridge touch --help (docs/bridges.md)\n";

/// The maker's program beside this one, as it is built, or where it is installed.
Result<std::filesystem::path> find_bridge(const std::string& maker) {
  const std::string program = "artus-bridge-" + maker;
  std::error_code error;
  const auto here = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const auto& file : {here / program, here / "../libexec/artus" / program})
    if (!error && access(file.c_str(), X_OK) == 0) return file;
  return fail(ErrorCode::not_found, program + " was not built or installed beside this program",
              here.string());
}

ExitCode become(const std::string& maker, std::vector<std::string> line) {
  const auto program = find_bridge(maker);
  if (!program) return report_error(program.error(), false);
  line.insert(line.begin(), "artus bridge " + maker);
  std::vector<char*> argv;
  for (std::string& argument : line) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(program->c_str(), argv.data());
  const std::error_code why(errno, std::generic_category());
  return report_error({ErrorCode::failed, why.message(), program->string()}, false);
}

ExitCode list_makers() {
  for (const char* maker : kMakers) {
    const pid_t child = fork();
    if (child == 0) std::exit(static_cast<int>(become(maker, {"--list"})));
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
  std::fprintf(stderr, "artus bridge: %s\n%s", what.c_str(), kForms);
  return ExitCode::usage;
}

}  // namespace

ExitCode run_bridge(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return misused("say which device");
  const std::string& first = arguments.front();
  if (first == "list") return list_makers();
  if (first == "--help" || first == "-h") {
    std::fputs(kForms, stdout);
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
  return become(maker, std::move(line));
}

/// For the list of commands: main() hands the line over before it is read.
void add_bridge_command(Command& app, ExitCode& code) {
  Command* command = add_command(
      app, "bridge", "Let a haptic device move and push: touch, force-dimension, haply", kForms);
  on_run(command, code, [] { return run_bridge({"--help"}); });
}

}  // namespace artus
