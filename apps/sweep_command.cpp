// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/apps/view_options.h"
#include "artus/dataset/sweep.h"

namespace artus {
namespace {

struct SweepCommandOptions {
  JointOptions joint;
  ViewOptions view;
  std::filesystem::path poses;
  std::filesystem::path out;
  bool restart = false;
  bool json = false;
};

ExitCode run_sweep_command(const SweepCommandOptions& options) {
  const auto poses = read_poses(options.poses);
  if (!poses) return report_error(poses.error(), options.json);
  const auto loaded = load_view(options.joint, options.view, options.json);
  if (!loaded) return report_error(loaded.error(), options.json);
  SweepOptions sweep_options;
  sweep_options.transducer = loaded->view.transducer;
  sweep_options.settings = loaded->view.settings;
  sweep_options.needle = loaded->view.needle_shape;
  sweep_options.restart = options.restart;
  const auto result = run_sweep(loaded->scene, *poses, options.out, sweep_options,
                                make_progress_printer(options.json));
  if (!result) return report_error(result.error(), options.json);
  if (options.json) {
    std::cout << nlohmann::json{{"joint", loaded->joint().name},
                                {"folder", options.out.string()},
                                {"poses", result->poses},
                                {"found", result->found},
                                {"drawn", result->drawn}}
                     .dump(2)
              << '\n';
  } else {
    std::printf("%zu poses: %zu were there, %zu drawn; truth.jsonl and frames/ in %s\n",
                result->poses, result->found, result->drawn, options.out.c_str());
  }
  return ExitCode::ok;
}

}  // namespace

void add_sweep_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<SweepCommandOptions>();
  Command* command = add_command(
      app, "sweep", "Many poses from a file: images, labels, masks and a line of truth for each",
      "A pose is a line of JSON, {\"probe\": {\"position_mm\": [x,y,z], \"direction\": [x,y,z],\n"
      "\"lateral\": [x,y,z]}, \"needle\": {\"entry_mm\": [x,y,z], \"tip_mm\": [x,y,z]}}, or a line "
      "of\n"
      "CSV under a header (docs/echography.md). A sweep that was stopped continues where it was.\n"
      "Examples:\n"
      "  artus sweep -j shoulder.artus --poses poses.jsonl --out out/sweep\n"
      "  artus sweep -j shoulder.artus --poses poses.csv --transducer linear-4-9 --depth 50 "
      "--out out/deep");
  add_joint_options(command, options->joint);
  command->add_option("--poses", options->poses, "list of poses (.jsonl, .csv)")->required();
  add_imaging_options(command, options->view);
  command->add_option("-o,--out", options->out, "folder for the results")->required();
  command->add_flag("--restart", options->restart, "throw away an earlier sweep of the folder");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_sweep_command(*options); });
}

}  // namespace artus
