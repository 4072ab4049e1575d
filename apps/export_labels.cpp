// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/export_labels.h"

#include <cstdio>
#include <iostream>

#include "artus/detail/anatomy/label_maps/label_writer.h"
#include "artus/detail/apps/options/arguments.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

Result<LabelGrid> grid_of(const LabelExportOptions& options) {
  LabelGrid grid;
  const auto spacing = parse_point_mm(options.spacing, "--spacing");
  ARTUS_TRY(spacing);
  const auto turn = parse_point_mm(options.turn, "--turn");  // three numbers, here degrees
  ARTUS_TRY(turn);
  grid.spacing = *spacing;
  grid.turn = *turn / kMillimetre * kDegree;
  grid.is_ras = options.axes == "RAS";
  return grid;
}

Result<JointLabels> write_labels(const LabelExportOptions& options, const CompiledJoint& joint) {
  const auto format = label_format_of(options.file);
  ARTUS_TRY(format);
  const auto grid = grid_of(options);
  ARTUS_TRY(grid);
  auto labels = label_joint(joint, *grid);
  ARTUS_TRY(labels);
  const auto bytes = to_label_file(*labels, *format, "artus " ARTUS_VERSION);
  if (!bytes) return fail(bytes.error().code, bytes.error().message, options.file.string());
  ARTUS_TRY(write_text(options.file, *bytes));
  if (!options.names.empty()) {
    const auto names = to_names_toml(*labels);
    ARTUS_TRY(names);
    ARTUS_TRY(write_text(options.names, *names));
  }
  return labels;
}

nlohmann::json to_json(const JointLabels& labels) {
  nlohmann::json segments = nlohmann::json::array();
  const double voxel = labels.volume.voxel_volume();
  for (std::size_t k = 0; k < labels.volume.segments.size(); ++k) {
    const LabelSegment& s = labels.volume.segments[k];
    segments.push_back({{"name", s.name},
                        {"label", s.value},
                        {"tissue", labels.tissues[k]},
                        {"voxels", s.n_voxels},
                        {"cm3", static_cast<double>(s.n_voxels) * voxel / kCubicCentimetre}});
  }
  const auto& size = labels.volume.size;
  return {{"size", {size[0], size[1], size[2]}},
          {"voxel_mm", labels.volume.voxel_edge() / kMillimetre},
          {"cut", labels.is_cut},
          {"labels", segments}};
}

void print(const LabelExportOptions& options, const JointLabels& labels) {
  const auto& size = labels.volume.size;
  std::printf("%5s %-32s %-14s %10s %10s\n", "label", "name", "tissue", "voxels", "cm3");
  for (std::size_t k = 0; k < labels.volume.segments.size(); ++k) {
    const LabelSegment& s = labels.volume.segments[k];
    std::printf("%5.0f %-32s %-14s %10zu %10.3f\n", s.value, s.name.c_str(),
                labels.tissues[k].c_str(), s.n_voxels,
                static_cast<double>(s.n_voxels) * labels.volume.voxel_volume() / kCubicCentimetre);
  }
  if (labels.is_cut)
    std::printf("! the joint ends within the body: there, the label map's border is no skin\n");
  if (const auto format = label_format_of(options.file);
      format && !holds_names(*format) && options.names.empty())
    std::printf(
        "! this format holds no names; --names FILE writes them for `artus import "
        "--labels FILE`\n");
  std::printf("%s: %zu x %zu x %zu voxels of %s mm\n", options.file.c_str(), size[0], size[1],
              size[2], options.spacing.c_str());
}

}  // namespace

void add_label_export_options(Command* command, LabelExportOptions& options) {
  command->add_option(
      "--labels", options.file,
      "the joint's regions as a label map: .nii, .nii.gz, .nrrd, .seg.nrrd, .mha or "
      ".dcm (DICOM SEG)");
  command->add_option("--names", options.names,
                      "names and tissues of its labels, as `artus import --labels` takes them");
  command->add_option("--spacing", options.spacing, "edges of its voxels, mm")
      ->capture_default_str();
  command->add_option("--axes", options.axes, "where its axes run")
      ->one_of({"LPS", "RAS"})
      ->capture_default_str();
  command->add_option("--turn", options.turn, "of the grid about the body's x, y and z, degrees")
      ->capture_default_str();
}

ExitCode export_labels(const LabelExportOptions& options, const JointOptions& joint_options,
                       bool json) {
  const auto joint = load(joint_options, make_progress_printer(json));
  if (!joint) return report_error(joint.error(), json);
  const auto labels = write_labels(options, **joint);
  if (!labels) return report_error(labels.error(), json);
  if (json)
    std::cout << to_json(*labels).dump(2) << '\n';
  else
    print(options, *labels);
  return ExitCode::ok;
}

}  // namespace artus
