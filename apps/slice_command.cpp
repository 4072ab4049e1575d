// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>

#include "core/units.h"
#include "echo/image_io.h"
#include "echo/labels.h"

#include "apps/view_options.h"

namespace artus {
namespace {

struct SliceOptions {
  JointOptions joint;
  ViewOptions view;
  std::filesystem::path out;
  std::filesystem::path ids;
  bool json = false;
};

/// What is in the plane: id, name, tissue, colour and area of each region.
nlohmann::json legend_of(const LabelImage& labels, const CompiledJoint& joint) {
  std::map<RegionId, std::size_t> pixels;
  for (const RegionId region : labels.regions) ++pixels[region];
  const auto palette = region_palette(joint);
  const double area = labels.pixel * labels.pixel / (kMillimetre * kMillimetre);
  auto legend = nlohmann::json::array();
  for (const auto& [region, count] : pixels)
    legend.push_back({{"id", region},
                      {"region", joint.regions[region].name},
                      {"tissue", joint.tissue_of(region).name},
                      {"rgb", palette[region]},
                      {"area_mm2", static_cast<double>(count) * area}});
  return legend;
}

cv::Mat id_image(const LabelImage& labels) {
  cv::Mat ids(labels.height, labels.width, CV_16UC1);
  std::copy(labels.regions.begin(), labels.regions.end(), ids.begin<std::uint16_t>());
  return ids;
}

ExitCode run_slice(const SliceOptions& options) {
  const auto view = make_view(options.view);
  if (!view) return report_error(view.error(), options.json);
  const auto joint = load(options.joint, make_progress_printer(options.json));
  if (!joint) return report_error(joint.error(), options.json);
  const Scene scene(*joint);
  const LabelImage labels = render_labels(scene, view->probe(**joint), view->transducer,
                                          view->settings, view->needle(**joint));
  if (const auto written = write_image(colour_labels(labels, **joint), options.out); !written)
    return report_error(written.error(), options.json);
  if (!options.ids.empty())
    if (const auto written = write_image(id_image(labels), options.ids); !written)
      return report_error(written.error(), options.json);

  const auto legend = legend_of(labels, **joint);
  if (options.json) {
    std::cout << nlohmann::json{{"joint", (*joint)->name},
                                {"image", options.out.string()},
                                {"pixel_mm", labels.pixel / kMillimetre},
                                {"regions", legend}}
                     .dump(2)
              << '\n';
    return ExitCode::ok;
  }
  std::printf("%4s %-28s %-16s %-12s %10s\n", "id", "region", "tissue", "red,grn,blu", "area mm2");
  for (const auto& row : legend)
    std::printf("%4d %-28s %-16s %3d,%3d,%3d  %10.1f\n", row["id"].get<int>(),
                row["region"].get<std::string>().c_str(), row["tissue"].get<std::string>().c_str(),
                row["rgb"][0].get<int>(), row["rgb"][1].get<int>(), row["rgb"][2].get<int>(),
                row["area_mm2"].get<double>());
  return ExitCode::ok;
}

}  // namespace

void add_slice_command(CLI::App& app, ExitCode& code) {
  auto options = std::make_shared<SliceOptions>();
  CLI::App* command = add_command(
      app, "slice", "The regions that truly lie in the probe's plane, at the B-mode image's scale",
      "Examples:\n"
      "  artus slice -j meshes/simple-shoulder -o labels.png\n"
      "  artus slice -j meshes/shoulder --needle default -o labels.png --ids ids.png --json");
  add_joint_options(command, options->joint);
  add_view_options(command, options->view);
  command->add_option("-o,--out", options->out, "colour image (.png)")->required();
  command->add_option("--ids", options->ids, "also write region ids (16-bit .png)");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_slice(*options); });
}

}  // namespace artus
