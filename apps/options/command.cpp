// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/command.h"

#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <locale>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/body/joint_path.h"
#include "artus/detail/anatomy/body/standard_view.h"
#include "artus/detail/core/plain_reason.h"
#include "artus/detail/soft/solver/pose_joint.h"

namespace artus {

Command* add_command(Command& app, const std::string& name, const std::string& description,
                     const std::string& footer) {
  Command* command = app.add_subcommand(name, description);
  command->footer(footer);
  return command;
}

void on_run(Command* command, ExitCode& code, std::function<ExitCode()> body) {
  command->callback([&code, body = std::move(body)] { code = body(); });
}

void on_run(Command* command, ExitCode& code, std::function<Result<void>()> body) {
  on_run(command, code, [body = std::move(body)] {
    const auto done = body();
    return done ? ExitCode::ok : report_error(done.error(), false);
  });
}

ExitCode report_error(const Error& error, bool json) {
  if (json) {
    std::cout << nlohmann::json{{"error",
                                 {{"code", to_string(error.code)},
                                  {"message", error.message},
                                  {"where", error.where}}}}
                     .dump(2)
              << '\n';
  }
  std::cerr << "artus: " << error.to_string() << '\n';
  const bool flag = error.where.rfind("--", 0) == 0;
  if (flag) return ExitCode::usage;
  return error.code == ErrorCode::defective ? ExitCode::defects : ExitCode::failed;
}

Progress make_progress_printer(bool quiet) {
  if (quiet) return {};
  const bool terminal = isatty(STDERR_FILENO) != 0;
  return [terminal, last = std::string(), percent = -1](std::string_view step,
                                                        double fraction) mutable {
    const int now = static_cast<int>(std::lround(100 * fraction));
    if (terminal) {
      if (step == last && now == percent) return;
      std::fprintf(stderr, "\r\033[K%.*s %d %%%s", static_cast<int>(step.size()), step.data(), now,
                   now >= 100 ? "\n" : "");
    } else if (step != last) {
      std::fprintf(stderr, "%.*s ...\n", static_cast<int>(step.size()), step.data());
    }
    last = step;
    percent = now;
  };
}

FlagCheck number_in(double low, double high) {
  std::ostringstream range;
  range << "a number from " << low << " to " << high;
  return FlagCheck{[low, high, wanted = range.str()](const std::string& text) {
                     std::istringstream in(text);
                     in.imbue(std::locale::classic());
                     double value = 0;
                     const bool is_number = (in >> value) && (in >> std::ws).eof();
                     const bool good = is_number && value >= low && value <= high;
                     return good ? std::string() : "'" + text + "' is not " + wanted;
                   },
                   range.str()};
}

FlagCheck whole_number_in(std::int64_t low, std::int64_t high) {
  const std::string wanted =
      "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
  return FlagCheck{[low, high, wanted](const std::string& text) {
                     std::int64_t value = 0;
                     const char* end = text.data() + text.size();
                     const auto read = std::from_chars(text.data(), end, value);
                     const bool good =
                         read.ec == std::errc{} && read.ptr == end && value >= low && value <= high;
                     return good ? std::string() : "'" + text + "' is not " + wanted;
                   },
                   wanted};
}

void add_patient_option(Command* command, std::string& patient) {
  command->add_option(
      "--patient", patient,
      "whose joint it is: a name of `artus patient list`, seed=7 (drawn), fat=12, or "
      "several with commas between; also JOINT@PATIENT");
}

void add_joint_options(Command* command, JointOptions& options) {
  command
      ->add_option(
          "--joint,-j", options.joint,
          "joint folder (with joint.toml), compiled .artus file, or the name of a bundled joint")
      ->required();
  command->add_option("--surfaces", options.surfaces,
                      "folder of the surface files, when not the joint's own");
  command->add_option("--cache", options.cache, "folder for compiled joints (default: user cache)");
  command->add_flag("--skip-refused", options.skip_refused,
                    "leave out structures that cannot be repaired instead of stopping");
  command->add_option("--pose", options.pose,
                      "how the joint is held: a [pose.NAME] of its file; else as it was compiled");
  command->add_option("--view", options.view,
                      "where the probe stands: a [view.NAME] of the joint's file, held as it says");
}

namespace {

/// The joint held and looked at as asked for; empty: as it is.
Result<CompiledJoint> in_pose(CompiledJoint joint, const std::string& pose_name,
                              const std::string& view_name) {
  std::string held = pose_name;
  std::optional<Pose> X_JP;
  if (!view_name.empty()) {
    const auto view = find_view(joint, view_name);
    ARTUS_TRY(view);
    if (held.empty()) held = view->pose;
    if (held == view->pose) X_JP = view->X_JP;
    joint.X_JP_default = view->X_JP;  // goes with the skin into a pose that is not the view's
  }
  if (!held.empty()) {
    const auto pose = find_pose(joint, held);
    ARTUS_TRY(pose);
    auto posed = pose_joint(joint, *pose);
    ARTUS_TRY(posed);
    joint = std::move(posed->joint);
  }
  if (X_JP) joint.X_JP_default = *X_JP;
  return joint;
}

}  // namespace

std::filesystem::path named_joint(const JointOptions& options) {
  return options.patient.empty() ? options.joint : with_patient(options.joint, options.patient);
}

Result<std::shared_ptr<const CompiledJoint>> load(const JointOptions& options,
                                                  const Progress& progress) {
  LoadOptions load_options;
  load_options.surfaces = options.surfaces;
  load_options.cache = options.cache;
  load_options.compile.skip_refused = options.skip_refused;
  auto joint = load_joint(named_joint(options), load_options, progress);
  ARTUS_TRY(joint);
  auto held = in_pose(std::move(*joint), options.pose, options.view);
  ARTUS_TRY(held);
  return std::make_shared<const CompiledJoint>(std::move(*held));
}

nlohmann::json to_json_mm(const Vec3& p) {
  return {p.x() * 1e3, p.y() * 1e3, p.z() * 1e3};
}

int run_program(const std::function<ExitCode()>& work) noexcept {
  std::setlocale(LC_ALL, "C");
  try {
    return static_cast<int>(work());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "artus: %s\n", plain_reason(e.what()).c_str());
  } catch (...) {
    std::fprintf(stderr, "artus: an unknown failure stopped the program\n");
  }
  return static_cast<int>(ExitCode::failed);
}

ExitCode run_commands(Command& app, int argc, const char* const* argv, const ExitCode& code) {
  int mistake = 0;  // CLI11's own many codes become one
  if (!app.parse(argc, argv, mistake)) return mistake == 0 ? ExitCode::ok : ExitCode::usage;
  return code;
}

}  // namespace artus
