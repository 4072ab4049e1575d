// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/result.h"
#include "artus/detail/apps/options/command_line.h"
#include "artus/detail/core/progress.h"

namespace artus {

/// What the process returns. A script can tell a bad flag from a bad mesh.
enum class ExitCode {
  ok = 0,
  failed = 1,   ///< the world is wrong: a file, a surface, a claim that does not hold
  usage = 2,    ///< the command line is wrong
  defects = 3,  ///< a surface, pose or injection must be mended; the same for every command
};

/// Adds a subcommand whose body runs after parsing and returns the exit code.
/// `footer` holds the examples that --help prints.
Command* add_command(Command& app, const std::string& name, const std::string& description,
                     const std::string& footer);

/// Runs `body` when `command` was chosen and keeps its result in `code`.
void on_run(Command* command, ExitCode& code, std::function<ExitCode()> body);
/// The same for a body that only fails or not, which is reported to people.
void on_run(Command* command, ExitCode& code, std::function<Result<void>()> body);

/// Prints an error for people on stderr, or as {"error": {...}} on stdout when `json`; returns
/// ExitCode::failed (usage for a malformed flag, defects for what must be mended).
ExitCode report_error(const Error& error, bool json);

/// A listener that prints steps and percentages on stderr: one line that is rewritten on a
/// terminal, one line a step otherwise. `quiet` gives one that prints nothing.
[[nodiscard]] Progress make_progress_printer(bool quiet);

/// --joint, --surfaces, --cache, --skip-refused, --pose, --view: where a joint comes from, how it
/// is held, and from where it is looked at.
struct JointOptions {
  std::filesystem::path joint;
  std::filesystem::path surfaces;
  std::filesystem::path cache;
  bool skip_refused = false;
  std::string pose;
  std::string view;
  std::string patient;
};
/// --patient, for commands whose --patient is not that of the needle's forces.
void add_patient_option(Command* command, std::string& patient);
void add_joint_options(Command* command, JointOptions& options);

/// The joint with its patient, as load_joint takes it.
[[nodiscard]] std::filesystem::path named_joint(const JointOptions& options);

/// Loads a compiled file, or compiles a joint folder (kept for the next time), in its pose, its
/// default probe where its view has it.
[[nodiscard]] Result<std::shared_ptr<const CompiledJoint>> load(const JointOptions& options,
                                                                const Progress& progress);

/// A point as [x, y, z] in millimetres.
[[nodiscard]] nlohmann::json to_json_mm(const Vec3& p);

/// Flags that must be a finite number from `low` to `high`, or a whole one. CLI11's own check lets
/// "nan" and "" through, and whole numbers that do not fit become the nearest that does.
[[nodiscard]] FlagCheck number_in(double low, double high);
[[nodiscard]] FlagCheck whole_number_in(std::int64_t low, std::int64_t high);

/// What every program does around its work: numbers with a point whatever the user's language, and
/// a failure that nothing caught is told in one line. Returns what the process returns.
[[nodiscard]] int run_program(const std::function<ExitCode()>& work) noexcept;

/// Parses the line and runs the chosen command, which keeps its result in `code`.
[[nodiscard]] ExitCode run_commands(Command& app, int argc, const char* const* argv,
                                    const ExitCode& code);

}  // namespace artus
