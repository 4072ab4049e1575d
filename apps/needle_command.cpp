// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "artus/detail/apps/options/arguments.h"
#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/units.h"
#include "artus/raycast/scene.h"

namespace artus {
namespace {

struct NeedleOptions {
  JointOptions joint;
  std::string entry;
  std::string tip;
  bool json = false;
};

void print_table(const CompiledJoint& joint, const std::vector<TissueInterval>& intervals) {
  std::printf("%-28s %-16s %10s %10s %10s\n", "region", "tissue", "entry mm", "exit mm",
              "length mm");
  for (const auto& interval : intervals)
    std::printf("%-28s %-16s %10.3f %10.3f %10.3f\n", joint.regions[interval.region].name.c_str(),
                joint.tissue_of(interval.region).name.c_str(), interval.entry / kMillimetre,
                interval.exit / kMillimetre, (interval.exit - interval.entry) / kMillimetre);
}

nlohmann::json to_json(const CompiledJoint& joint, const std::vector<TissueInterval>& intervals) {
  auto list = nlohmann::json::array();
  for (const auto& interval : intervals)
    list.push_back(
        {{"region", joint.regions[interval.region].name},
         {"tissue", joint.tissue_of(interval.region).name},
         {"entry_mm", interval.entry / kMillimetre},
         {"exit_mm", interval.exit / kMillimetre},
         {"entry_normal",
          {interval.entry_normal.x(), interval.entry_normal.y(), interval.entry_normal.z()}}});
  return {{"joint", joint.name}, {"intervals", list}};
}

/// The line of the flags; none when they are not given.
Result<std::optional<Segment>> line_of(const NeedleOptions& options) {
  if (options.entry.empty() && options.tip.empty()) return std::optional<Segment>();
  const auto entry = parse_point_mm(options.entry, "--entry");
  ARTUS_TRY(entry);
  const auto tip = parse_point_mm(options.tip, "--tip");
  ARTUS_TRY(tip);
  if ((*tip - *entry).norm() < 1e-9)
    return fail(ErrorCode::invalid, "entry and tip are the same point", "--tip");
  return std::optional<Segment>({*entry, *tip});
}

/// The joint's needle from where it enters the skin.
Segment default_line(const Scene& scene) {
  constexpr double kLongest = 0.2;     // m, more than any needle
  constexpr double kUnderSkin = 1e-6;  // m, so that no sliver of outside is the first layer
  const Pose& X_JN = scene.joint().X_JN_default;
  const Vec3 axis = X_JN.linear().col(2);
  const Vec3 tip = X_JN.translation();
  double entry = 0;
  for (const TissueInterval& s : tissue_intervals(scene, {tip - kLongest * axis, tip}))
    if (s.region < kFirstRegion) entry = s.exit + kUnderSkin;
  return {tip - (kLongest - entry) * axis, tip};
}

ExitCode run_needle(const NeedleOptions& options) {
  const auto line = line_of(options);
  if (!line) return report_error(line.error(), options.json);
  const auto joint = load(options.joint, make_progress_printer(options.json));
  if (!joint) return report_error(joint.error(), options.json);
  const Scene scene(*joint);
  const auto intervals = tissue_intervals(scene, line->value_or(default_line(scene)));
  if (options.json)
    std::cout << to_json(**joint, intervals).dump(2) << '\n';
  else
    print_table(**joint, intervals);
  return ExitCode::ok;
}

}  // namespace

void add_needle_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<NeedleOptions>();
  Command* command = add_command(
      app, "needle", "What a straight needle passes through, layer by layer",
      "Points are x,y,z in millimetres of the joint frame; without them the joint's own\n"
      "needle is taken, from the skin to its tip.\n"
      "Examples:\n"
      "  artus needle -j meshes/shoulder\n"
      "  artus needle -j meshes/simple-shoulder --entry=-51.8,0,-13.9 --tip=-20,0,-5\n"
      "  artus needle -j real.artus --entry=-235,-60,1330 --tip=-195,-50,1340 --json");
  add_joint_options(command, options->joint);
  add_patient_option(command, options->joint.patient);
  Option* entry =
      command->add_option("--entry", options->entry, "start of the line, usually on the skin");
  Option* tip = command->add_option("--tip", options->tip, "needle tip");
  entry->needs(tip);
  tip->needs(entry);
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_needle(*options); });
}

}  // namespace artus
