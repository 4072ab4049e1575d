// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include "artus/dataset/pose_list.h"
#include "artus/detail/apps/options/hand_options.h"
#include "artus/detail/apps/options/pose_files.h"
#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/core/csv.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/simulation/trajectory_forces.h"
#include "artus/raycast/scene.h"

namespace artus {
namespace {

struct ForceOptions {
  JointOptions joint;
  FeelOptions feel;
  std::filesystem::path poses;
  TrackerFileOptions tracker;
  std::filesystem::path out;
  std::string device = "ideal";
  double rate = 1000;
  bool rigid = false;
  bool json = false;
};

/// The needle at every tick. Errors: those of read_any_poses and sample_path; invalid, a pose
/// without needle or time.
Result<std::vector<TrajectoryPose>> needle_path(const ForceOptions& options) {
  const auto listed = read_any_poses(options.poses, options.tracker, PoseHand::needle);
  ARTUS_TRY(listed);
  const auto ticks = sample_path(*listed, options.rate);
  if (!ticks) return fail(ticks.error().code, ticks.error().message, options.poses.string());
  std::vector<TrajectoryPose> path;
  path.reserve(ticks->size());
  for (const ListedPose& pose : *ticks) {
    if (!pose.X_JN)
      return fail(ErrorCode::invalid,
                  "every pose needs a needle: pose " + std::to_string(path.size()) + " has none",
                  options.poses.string());
    path.push_back({*pose.X_JN, pose.has_probe ? std::optional(pose.X_JP) : std::nullopt});
  }
  return path;
}

std::string to_table(const std::vector<TrajectoryForce>& forces, double rate,
                     const CompiledJoint& joint) {
  std::string out = "time_s,depth_mm,region,fx_n,fy_n,fz_n,axial_n,tx_nm,ty_nm,tz_nm,status\n";
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const TrajectoryForce& f = forces[i];
    out += to_csv(static_cast<double>(i) / rate) + "," + to_csv(f.depth / kMillimetre) + "," +
           joint.regions[f.region].name;
    for (const double value :
         {f.force.x(), f.force.y(), f.force.z(), f.axial, f.torque.x(), f.torque.y(), f.torque.z()})
      out += "," + to_csv(value);
    out += "," + std::to_string(f.status) + "\n";
  }
  return out;
}

ExitCode run_force(const ForceOptions& options) {
  const auto path = needle_path(options);
  if (!path) return report_error(path.error(), options.json);
  const auto joint = load(options.joint, make_progress_printer(options.json));
  if (!joint) return report_error(joint.error(), options.json);
  const auto feel = make_feel(options.feel, **joint);
  if (!feel) return report_error(feel.error(), options.json);
  const auto scene = std::make_shared<const Scene>(*joint);
  auto params = trajectory_params(*scene, options.device, options.rate, options.rigid);
  if (!params) return report_error(params.error(), options.json);
  params->feel = *feel;
  const auto forces = compute_trajectory_forces(scene, *path, *params);
  if (!forces) return report_error(forces.error(), options.json);
  const auto written = write_text(options.out, to_table(*forces, options.rate, **joint));
  if (!written) return report_error(written.error(), options.json);
  double most = 0;
  for (const TrajectoryForce& f : *forces) most = std::max(most, f.force.norm());
  if (options.json)
    std::cout << nlohmann::json{{"ticks", forces->size()}, {"largest_n", most}}.dump(2) << '\n';
  else
    std::printf("%zu ticks, largest force %.3f N: %s\n", forces->size(), most, options.out.c_str());
  return ExitCode::ok;
}

}  // namespace

void add_force_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<ForceOptions>();
  Command* command = add_command(
      app, "force", "What the hand feels along any trajectory of the needle, as CSV",
      "Poses as for sweep (docs/echography.md), each with a needle; with time_s they are sampled\n"
      "at the rate, without each is one tick. Only the needle is needed; where the tissue gives\n"
      "way, a probe that the poses have presses on it, too. axial_n is the force along the "
      "needle,\n"
      "positive against insertion, as in the trace of inject.\n"
      "Examples:\n"
      "  artus force -j shoulder.artus --poses path.csv -o force.csv\n"
      "  artus force -j shoulder.artus --poses path.jsonl --rate 4000 --device touch -o force.csv");
  add_joint_options(command, options->joint);
  add_feel_options(command, options->feel);
  command->add_option("--poses", options->poses, "list of poses, or a tracker's file")->required();
  add_tracker_file_options(command, options->tracker);
  add_haptic_rate_option(command, options->rate, "--rate,--haptic-rate");
  add_device_option(command, options->device);
  command->add_option("-o,--out", options->out, "CSV")->required();
  add_rigid_option(command, options->rigid);
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_force(*options); });
}

}  // namespace artus
