// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/exchange/landmark_registration.h"
#include "artus/detail/exchange/tracker_calibration.h"

namespace artus {
namespace {

struct RegisterOptions {
  JointOptions joint;
  std::filesystem::path pairs;
  std::filesystem::path calibration;
  std::filesystem::path out;
  double limit_mm = 5;
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

ExitCode run_register(const RegisterOptions& options) {
  const auto joint = load(options.joint, make_progress_printer(options.json));
  if (!joint) return report_error(joint.error(), options.json);
  const auto pairs = read_landmark_pairs(options.pairs, **joint);
  if (!pairs) return report_error(pairs.error(), options.json);
  TrackerCalibration calibration;
  if (!options.calibration.empty()) {
    const auto earlier = read_tracker_calibration(options.calibration);
    if (!earlier) return report_error(earlier.error(), options.json);
    calibration = *earlier;
  }
  const auto fit = register_landmarks(*pairs, options.limit_mm * kMillimetre);
  if (!fit) return report_error(fit.error(), options.json);
  calibration.X_JR = fit->X_JR;
  calibration.registered = true;
  const auto written = write_text(options.out, to_toml(calibration));
  if (!written) return report_error(written.error(), options.json);
  print(*pairs, *fit, options.json);
  return ExitCode::ok;
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
      "  artus register -j real.artus --pairs pairs.csv --calibration probe.toml -o tracker.toml");
  add_joint_options(command, options->joint);
  command->add_option("--pairs", options->pairs, "landmarks and touched points (.csv)")->required();
  command->add_option("--calibration", options->calibration,
                      "take the sensors' places on probe and needle from this file");
  command->add_option("--limit-mm", options->limit_mm, "refuse a fit that is worse than this (rms)")
      ->check(number_in(0.01, 100))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "calibration for --calibration of serve and view")
      ->required();
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_register(*options); });
}

}  // namespace artus
