// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/exchange/landmark_registration.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/tracker_calibration.h"
#include "artus/detail/training/scenario.h"

namespace artus {
namespace {

struct RegisterOptions {
  JointOptions joint;
  std::filesystem::path pairs;
  std::string scenario;
  std::string insertion;
  std::filesystem::path calibration;
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

Result<void> run_register(const RegisterOptions& options) {
  if (options.pairs.empty() && options.scenario.empty() && options.insertion.empty())
    return fail(ErrorCode::malformed, "say how: --pairs, --scenario or --insertion", "--pairs");
  TrackerCalibration calibration;
  if (!options.calibration.empty()) {
    auto earlier = read_tracker_calibration(options.calibration);
    ARTUS_TRY(earlier);
    calibration = *earlier;
  }
  if (options.scale != 1) calibration.scale = options.scale;
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
      "the tracked tip was when it touched them. Three or more, not on a line.\n"
      "Examples:\n"
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
  command->add_option("--calibration", options->calibration,
                      "take the sensors' places on probe and needle from this file");
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
