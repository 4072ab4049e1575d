// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/apps/options/igtl_options.h"
#include "artus/detail/apps/options/interrupts.h"
#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/apps/options/window_options.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/exchange/landmark_registration.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/tracker_calibration.h"
#include "artus/detail/session/session_thread.h"
#include "artus/detail/trainer/register_page.h"
#include "artus/detail/training/scenario.h"
#include "artus/session/shared_memory_device.h"

namespace artus {
namespace {

struct RegisterOptions {
  JointOptions joint;
  std::filesystem::path pairs;
  std::string scenario;
  std::string insertion;
  IgtlOptions igtl;   // whose calibration is the earlier one
  std::string input;  // igtl or shared-memory; empty: no hand is watched
  std::string prefix;
  WindowOptions window;
  std::string language;
  std::filesystem::path script;
  std::filesystem::path out;
  double limit_mm = 5;
  double scale = 1;
  bool json = false;
};

void print(const std::vector<LandmarkPair>& pairs, const Registration& fit, bool json) {
  if (json) {
    nlohmann::json residuals;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      residuals[pairs[i].name] = fit.residuals[i] / kMillimetre;
    std::cout
        << nlohmann::json{{"residuals_mm", residuals}, {"rms_mm", fit.rms / kMillimetre}}.dump(2)
        << '\n';
    return;
  }
  for (std::size_t i = 0; i < pairs.size(); ++i)
    std::printf("%-24s %6.2f mm\n", pairs[i].name.c_str(), fit.residuals[i] / kMillimetre);
  std::printf("%-24s %6.2f mm\n", "rms", fit.rms / kMillimetre);
}

/// By landmarks that were touched, with what their fit is printed.
Result<void> register_by_pairs(const RegisterOptions& options, TrackerCalibration& calibration) {
  if (options.joint.joint.empty() && options.joint.surfaces.empty())
    return fail(ErrorCode::malformed, "landmarks are a joint's: name it", "--joint");
  const auto joint = load(options.joint, make_progress_printer(options.json));
  ARTUS_TRY(joint);
  auto pairs = read_landmark_pairs(options.pairs, **joint);
  ARTUS_TRY(pairs);
  for (LandmarkPair& pair : *pairs) pair.p_R *= calibration.scale;
  const auto fit = register_landmarks(*pairs, options.limit_mm * kMillimetre);
  ARTUS_TRY(fit);
  calibration.X_JR = fit->X_JR;
  calibration.registered = true;
  print(*pairs, *fit, options.json);
  return {};
}

/// "x,y,z,ax,ay,az" as the place where a device lets a needle in.
Result<void> take_insertion(const std::string& text, TrackerCalibration& calibration) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  TextCursor cursor(spaced, "--insertion");
  std::array<double, 6> numbers{};
  for (double& number : numbers) number = cursor.next_number().value_or(std::nan(""));
  GestureParams gesture = calibration.insertion.value_or(GestureParams());
  gesture.p_W = kMillimetre * Vec3(numbers[0], numbers[1], numbers[2]);
  const Vec3 axis(numbers[3], numbers[4], numbers[5]);
  if (!cursor.next().empty() || !gesture.p_W.allFinite() || !(axis.norm() > 1e-9))
    return fail(ErrorCode::malformed, "write six numbers: x,y,z in mm of W, then a direction",
                "--insertion");
  gesture.axis_W = axis.normalized();
  calibration.insertion = gesture;
  return {};
}

/// A device that says where the needle is in its own frame, and what keeps it going.
struct WatchedHand {
  std::unique_ptr<SessionLink> link;
  std::unique_ptr<InputDevice> device;
};

/// Errors: those of the tracker's server and of the shared memory.
Result<WatchedHand> open_hand(const RegisterOptions& options,
                              const TrackerCalibration& calibration) {
  WatchedHand hand;
  if (options.input == "shared-memory") {
    auto device = SharedMemoryDevice::open(options.prefix, {});
    ARTUS_TRY(device);
    hand.device = std::move(*device);
    return hand;
  }
  TrackerInput tracker{calibration, nullptr};
  tracker.calibration.X_JR = Pose::Identity();  // poses stay in the tracker's Reference
  tracker.calibration.registered = true;
  tracker.inbox = std::make_shared<TrackerInbox>(
      tracker.calibration, TrackerInbox::Names{options.igtl.probe, options.igtl.needle});
  auto link = open_session_link(options.igtl, tracker);
  ARTUS_TRY(link);
  hand.link = std::move(*link);
  auto device = make_tracker_device(options.igtl, tracker);
  ARTUS_TRY(device);
  hand.device = std::move(*device);
  return hand;
}

/// By a page that leads from landmark to landmark.
Result<void> register_in_window(RegisterOptions& options, const TrackerCalibration& calibration) {
  std::vector<Landmark> landmarks;
  if (options.input != "shared-memory") {
    if (options.joint.joint.empty() && options.joint.surfaces.empty())
      return fail(ErrorCode::malformed, "landmarks are a joint's: name it", "--joint");
    const auto joint = load(options.joint, make_progress_printer(false));
    ARTUS_TRY(joint);
    landmarks = (*joint)->landmarks;
  }
  const auto hand = open_hand(options, calibration);
  ARTUS_TRY(hand);
  PageScript script;
  if (!options.script.empty()) {
    auto steps = read_script(options.script);
    ARTUS_TRY(steps);
    script = PageScript(std::move(*steps));
  }
  Interrupts interrupts;
  const auto screen = Screen::open(options.window.width, options.window.height);
  ARTUS_TRY(screen);
  const Language language = language_of(options.language);
  PageWindow pages(**screen, {language, KeyMap(), options.window.font_scale, &script, [&] {
                                return interrupts.wait(0);
                              }});
  TouchedLandmarks touched(std::move(landmarks), options.limit_mm * kMillimetre);
  const auto needle = [&]() -> std::optional<Pose> {
    const DeviceSample sample = hand->device->read(monotonic_ns());
    if (sample.state != PeerState::alive || sample.has_needle == 0) return std::nullopt;
    return to_pose(sample.X_WN);
  };
  const auto save = [&](const TrackerCalibration& known) {
    return write_text(options.out, to_toml(known));
  };
  const auto saved = lead_to_registration(pages, touched, needle, calibration, save, language);
  ARTUS_TRY(saved);
  if (*saved)
    std::fprintf(stderr, "%s: written\n", options.out.c_str());
  else
    std::fprintf(stderr, "nothing was saved\n");
  return {};
}

Result<void> run_register(RegisterOptions& options) {
  const bool in_window = !options.input.empty();
  if (options.pairs.empty() && options.scenario.empty() && options.insertion.empty() && !in_window)
    return fail(ErrorCode::malformed,
                "say how: --input (a page leads you), --pairs, --scenario or --insertion",
                "--pairs");
  TrackerCalibration calibration;
  if (!options.igtl.calibration.empty()) {
    auto earlier = read_tracker_calibration(options.igtl.calibration);
    ARTUS_TRY(earlier);
    calibration = *earlier;
  }
  if (options.scale != 1) calibration.scale = options.scale;
  if (in_window) return register_in_window(options, calibration);
  if (!options.insertion.empty()) ARTUS_TRY(take_insertion(options.insertion, calibration));
  if (!options.scenario.empty()) {
    const auto scenario = find_scenario(options.scenario);
    ARTUS_TRY(scenario);
    calibration.X_JR = block_in_joint(scenario->X_JP);
    calibration.registered = true;
  }
  if (!options.pairs.empty()) ARTUS_TRY(register_by_pairs(options, calibration));
  return write_text(options.out, to_toml(calibration));
}

}  // namespace

void add_register_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<RegisterOptions>();
  Command* command = add_command(
      app, "register", "A tracker's Reference in the joint, from landmarks that were touched",
      "The pairs are CSV, landmark,x_mm,y_mm,z_mm: the names of the joint's landmarks, and where\n"
      "the tracked tip was when it touched them. Three or more, not on a line. With --input a "
      "page\n"
      "leads from landmark to landmark; with --prefix to the place where a device lets a needle "
      "in.\n"
      "Examples:\n"
      "  artus register -j shoulder --input igtl --igtl 18944 -o tracker.toml\n"
      "  artus register --input shared-memory -o device.toml\n"
      "  artus register -j real.artus --pairs pairs.csv -o tracker.toml\n"
      "  artus register -j real.artus --pairs pairs.csv --calibration probe.toml -o tracker.toml\n"
      "  artus register --scenario gel-find -o block.toml     a block on a table, z up from its "
      "top\n"
      "  artus register --insertion 0,0,0,0,0,-1 -o device.toml     where a device lets a needle "
      "in");
  add_joint_options(command, options->joint);
  command->get_option("--joint")->required(false);
  command->add_option("--pairs", options->pairs, "landmarks and touched points (.csv)");
  command->add_option("--scenario", options->scenario,
                      "the middle of a block's top is where this task's probe stands at first");
  command->add_option(
      "--insertion", options->insertion,
      "x,y,z,ax,ay,az: where a device lets a needle in, mm of W, and its direction");
  command->add_option("--scale", options->scale, "true lengths over those that the tracker says")
      ->check(number_in(0.5, 2))
      ->capture_default_str();
  add_igtl_options(command, options->igtl);
  command
      ->add_option("--input", options->input,
                   "igtl or shared-memory: watch this hand, and lead through it in a window")
      ->one_of({"igtl", "shared-memory"});
  add_prefix_option(command, options->prefix);
  add_window_options(command, options->window, options->language);
  command->add_option("--script", options->script, "steps of the page's user, for tests and films");
  command->add_option("--limit-mm", options->limit_mm, "refuse a fit that is worse than this (rms)")
      ->check(number_in(0.01, 100))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "calibration for --calibration of serve and view")
      ->required();
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] {
    const auto done = run_register(*options);
    return done ? ExitCode::ok : report_error(done.error(), options->json);
  });
}

}  // namespace artus
