// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/apps/options/press_options.h"
#include "artus/detail/apps/options/view_options.h"
#include "artus/detail/core/units.h"
#include "artus/detail/dataset/echo_truth.h"
#include "artus/echo/image_io.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

struct SliceOptions {
  JointOptions joint;
  ViewOptions view;
  PressOptions press;
  std::filesystem::path out;
  std::filesystem::path ids;
  std::string truth = "shown";
  bool json = false;
};

/// What is in the plane, with the colours of the picture.
nlohmann::json legend_of(const LabelImage& labels, const CompiledJoint& joint) {
  auto legend = region_list(labels, joint);
  const auto palette = region_palette(joint);
  for (auto& row : legend) row["rgb"] = palette[row.at("id").get<std::size_t>()];
  return legend;
}

ExitCode run_slice(const SliceOptions& options) {
  auto loaded = load_view(options.joint, options.view, options.json);
  if (!loaded) return report_error(loaded.error(), options.json);
  const auto pressed = press(*loaded, options.press);
  if (!pressed) return report_error(pressed.error(), options.json);
  const CompiledJoint& joint = loaded->joint();
  const View& view = loaded->view;
  const LabelImage labels =
      options.truth == "true"
          ? render_labels(*loaded->scene, loaded->X_JP, view.transducer, view.settings,
                          loaded->needle)
          : render_shown_labels(Renderer(loaded->scene, view.transducer, view.settings),
                                loaded->X_JP, loaded->needle);
  if (const auto written = write_image(colour_labels(labels, joint), options.out); !written)
    return report_error(written.error(), options.json);
  if (!options.ids.empty())
    if (const auto written = write_image(id_image(labels), options.ids); !written)
      return report_error(written.error(), options.json);

  const auto legend = legend_of(labels, joint);
  if (options.json) {
    nlohmann::json report{{"joint", joint.name},
                          {"image", options.out.string()},
                          {"pixel_mm", labels.pixel / kMillimetre},
                          {"truth", options.truth},
                          {"regions", legend}};
    if (!pressed->is_null()) report["press"] = *pressed;
    std::cout << report.dump(2) << '\n';
    return ExitCode::ok;
  }
  print_press(*pressed);
  std::printf("%4s %-28s %-16s %-12s %10s\n", "id", "region", "tissue", "red,grn,blu", "area mm2");
  for (const auto& row : legend)
    std::printf("%4d %-28s %-16s %3d,%3d,%3d  %10.1f\n", row["id"].get<int>(),
                row["region"].get<std::string>().c_str(), row["tissue"].get<std::string>().c_str(),
                row["rgb"][0].get<int>(), row["rgb"][1].get<int>(), row["rgb"][2].get<int>(),
                row["area_mm2"].get<double>());
  return ExitCode::ok;
}

}  // namespace

void add_slice_command(Command& image, ExitCode& code) {
  auto options = std::make_shared<SliceOptions>();
  Command* command =
      add_command(image, "labels", "The regions in the probe's plane, at the B-mode image's scale",
                  "Examples:\n"
                  "  artus image labels -j meshes/simple-shoulder -o labels.png\n"
                  "  artus image labels -j meshes/shoulder --press-mm 5 -o pressed.png\n"
                  "  artus image labels -j meshes/shoulder --needle default -o labels.png --ids "
                  "ids.png --json");
  add_joint_options(command, options->joint);
  add_patient_option(command, options->joint.patient);
  add_view_options(command, options->view);
  add_press_options(command, options->press);
  add_drag_option(command, options->press);
  command->add_option("-o,--out", options->out, "colour image (.png)")->required();
  command->add_option("--ids", options->ids, "also write region ids (16-bit .png)");
  command
      ->add_option("--truth", options->truth,
                   "shown: where the picture has them, by the speeds and bends of sound; true: "
                   "where they are")
      ->one_of({"shown", "true"})
      ->capture_default_str();
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_slice(*options); });
}

}  // namespace artus
