// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/apps/options/device_options.h"
#include "artus/detail/apps/options/feel_options.h"
#include "artus/detail/apps/options/igtl_options.h"
#include "artus/detail/apps/options/plan_options.h"
#include "artus/detail/session/hand_device.h"
#include "artus/session/session.h"

namespace artus {

/// The flags of every command that runs a session.
struct SessionOptions {
  JointOptions joint;
  FeelOptions feel;
  PlanOptions plan;
  std::string device = "touch";
  OwnDeviceOptions own_device;
  double haptic_rate = 1000;
  double image_rate = 40;
  std::string input = "shared-memory";
  std::string prefix;
  std::filesystem::path recording;
  double speed_mm_s = 10;
  int injection = 1;
  double give_ml = 0;
  double syringe_ml = 5;
  int gauge = 22;
  std::string liquid = "saline";
  int haptic_cpu = -1;
  int haptic_priority = Session::Options().haptic_options.fifo_priority;
  int threads = 0;
  bool rigid = false;
  std::filesystem::path histograms;
  IgtlOptions igtl;
};
/// --prefix, checked as the shared memory does.
void add_prefix_option(Command* command, std::string& prefix);
void add_session_options(Command* command, SessionOptions& options,
                         const std::string& default_input);

/// The params that the flags mean for a joint. Errors: not_found (device), invalid (rates).
/// --rigid of every command that runs hands in a body.
void add_rigid_option(Command* command, bool& rigid);

[[nodiscard]] Result<SessionParams> make_session_params(const SessionOptions& options,
                                                        const CompiledJoint& joint);

/// Where its threads run, what they keep and the names of what they share.
[[nodiscard]] Session::Options make_thread_options(const SessionOptions& options);

/// The injection that --injection chooses of the joint's, or of those of --entry and --target;
/// empty when there is none to choose from and none was asked for. Errors: those of make_plan;
/// not_found.
[[nodiscard]] Result<std::optional<PlannedInjection>> chosen_injection(
    const SessionOptions& options, const CompiledJoint& joint);

/// Needle and probe at the start: the joint's default probe, the needle above the planned entry, or
/// the joint's default needle.
[[nodiscard]] HandTarget first_target(const CompiledJoint& joint,
                                      const std::optional<PlannedInjection>& plan);

/// The device that --input names; `hand` is set when it is the hand of mouse and keyboard.
/// `tracker`: what --input igtl reads.
[[nodiscard]] Result<std::unique_ptr<InputDevice>> make_device(const SessionOptions& options,
                                                               const SessionParams& params,
                                                               const CompiledJoint& joint,
                                                               const TrackerInput& tracker,
                                                               HandDevice** hand);

/// Percentiles of a session's times, one line each, on stdout.
void print_times(const SessionTimes& times, const SessionParams& params);
/// One such line, us.
void print_line(const char* what, const LatencyHistogram& h);
/// The histograms as CSV: a row a bin, upper edge in us, then how many fell into it. Nothing when
/// `file` is empty. Errors: unreadable.
[[nodiscard]] Result<void> write_histograms(const std::filesystem::path& file,
                                            const SessionTimes& times);
[[nodiscard]] nlohmann::json to_json(const SessionTimes& times);

}  // namespace artus
