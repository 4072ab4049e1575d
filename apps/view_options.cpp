// SPDX-License-Identifier: AGPL-3.0-or-later
#include "apps/view_options.h"

#include "core/units.h"

#include "apps/arguments.h"

namespace artus {

void add_view_options(CLI::App* command, ViewOptions& options) {
  command->add_option("--probe", options.probe,
                      "position/direction[/lateral], each x,y,z; position in mm "
                      "(default: the joint's probe pose)");
  command->add_option("--needle", options.needle,
                      "entry/tip, each x,y,z in mm, or 'default' for the joint's (default: none)");
  command->add_option("--gauge", options.gauge, "needle gauge: 18, 20, 21, 22, 23 or 25")
      ->capture_default_str();
  command->add_flag("--echogenic", options.echogenic, "dimpled needle, seen at steep angles, too");
  command->add_option("--depth", options.depth_mm, "image depth, mm")->capture_default_str();
  command->add_option("--gain", options.gain_db, "gain, dB")->capture_default_str();
  command->add_option("--dynamic-range", options.dynamic_range_db, "dB between black and white")
      ->capture_default_str();
  command->add_option("--frequency", options.frequency_mhz, "centre frequency, MHz")
      ->capture_default_str();
  command->add_option("--focus", options.focus_mm, "elevation focus of the lens, mm")
      ->capture_default_str();
  command->add_option("--pixel", options.pixel_mm, "pixel size, mm")->capture_default_str();
  command->add_option("--lines", options.lines, "scanlines")->capture_default_str();
  command->add_option("--planes", options.planes, "elevation planes of the slice's thickness")
      ->capture_default_str();
  command
      ->add_option("--threads", options.threads, "threads; 0: all. The image does not depend on it")
      ->capture_default_str();
  command->add_option("--seed", options.seed, "seed of speckle and noise")->capture_default_str();
}

Result<View> make_view(const ViewOptions& options) {
  View view;
  if (!options.probe.empty()) {
    const auto pose = parse_probe_pose(options.probe, "--probe");
    if (!pose) return tl::unexpected(pose.error());
    view.X_JP = *pose;
  }
  view.default_needle = options.needle == "default";
  if (!options.needle.empty() && !view.default_needle) {
    const auto pose = parse_needle_pose(options.needle, "--needle");
    if (!pose) return tl::unexpected(pose.error());
    view.X_JN = *pose;
  }
  const auto shape = needle_of_gauge(options.gauge);
  if (!shape)
    return fail(
        ErrorCode::invalid,
        "no needle of gauge " + std::to_string(options.gauge) + "; choose 18, 20, 21, 22, 23 or 25",
        "--gauge");
  view.needle_shape = *shape;
  view.needle_shape.echogenic = options.echogenic;
  view.transducer.frequency = options.frequency_mhz * 1e6;
  view.transducer.elevation_focus = options.focus_mm * kMillimetre;
  view.transducer.n_lines = options.lines;
  view.settings.depth = options.depth_mm * kMillimetre;
  view.settings.gain_db = options.gain_db;
  view.settings.dynamic_range_db = options.dynamic_range_db;
  view.settings.pixel = options.pixel_mm * kMillimetre;
  view.settings.n_planes = options.planes;
  view.settings.n_threads = options.threads;
  view.settings.seed = options.seed;
  for (const auto& valid : {validate(view.transducer), validate(view.settings)})
    if (!valid) {
      Error error = valid.error();
      error.where = "--" + (error.where.empty() ? "depth" : error.where);
      return tl::unexpected(error);
    }
  return view;
}

Pose View::probe(const CompiledJoint& joint) const {
  return X_JP.value_or(joint.X_JP_default);
}

std::optional<NeedleView> View::needle(const CompiledJoint& joint) const {
  if (X_JN) return NeedleView{*X_JN, needle_shape};
  if (default_needle) return NeedleView{joint.X_JN_default, needle_shape};
  return std::nullopt;
}

}  // namespace artus
