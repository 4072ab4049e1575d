// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/apps/options/view_options.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/dataset/echo_truth.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "artus/echo/image_io.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

constexpr double kWaterPath = 50e-3;  // m: phantoms are scanned under water, whatever the face

struct PhantomCommandOptions {
  std::string name;
  ViewOptions view;
  double needle_angle_deg = 0;
  double needle_depth_mm = 20;
  std::filesystem::path out;
  bool json = false;
};

Result<nlohmann::json> draw_phantom(const EchoPhantom& phantom, const View& view,
                                    const std::filesystem::path& out) {
  ARTUS_TRY(make_folder(out));
  Renderer renderer(phantom.scene, view.transducer, view.settings);
  renderer.set_point_reflectors(phantom.reflectors);
  const Frame& frame = renderer.render(phantom.X_JP, phantom.needle);
  const LabelImage labels = render_shown_labels(renderer, phantom.X_JP, phantom.needle);
  nlohmann::json truth{{"phantom", phantom.name},
                       {"title", phantom.title},
                       {"object", phantom.truth},
                       {"transducer", to_json(view.transducer)},
                       {"settings", to_json(view.settings)},
                       {"regions", region_list(labels, phantom.scene->joint())}};
  if (phantom.needle)
    truth["needle"] =
        to_json(locate_needle(*phantom.needle, phantom.X_JP, view.transducer, view.settings),
                frame.tip_shown);
  for (const auto& ok :
       {write_image(annotated_image(frame, view.transducer), out / "bmode.png"),
        write_image(grey_image(frame), out / "grey.png"),
        write_envelope(frame, out / "envelope.tiff"),
        write_image(colour_labels(labels, phantom.scene->joint()), out / "labels.png"),
        write_image(id_image(labels), out / "ids.png"),
        write_text(out / "truth.json", truth.dump(2) + "\n")})
    ARTUS_TRY(ok);
  return truth;
}

ExitCode run_phantom(const PhantomCommandOptions& options) {
  auto view = make_view(options.view);
  if (!view) return report_error(view.error(), options.json);
  view->settings.gel_limit = kWaterPath;
  PhantomOptions phantom_options;
  phantom_options.needle = view->needle_shape;
  phantom_options.needle_angle = options.needle_angle_deg * kDegree;
  phantom_options.needle_depth = options.needle_depth_mm * kMillimetre;
  const auto phantom = make_echo_phantom(options.name, phantom_options);
  if (!phantom) return report_error(phantom.error(), options.json);
  const auto truth = draw_phantom(*phantom, *view, options.out);
  if (!truth) return report_error(truth.error(), options.json);
  if (options.json)
    std::cout << truth->dump(2) << '\n';
  else
    std::printf(
        "%s: %s\nbmode.png, grey.png, envelope.tiff, labels.png, ids.png, truth.json in %s\n",
        phantom->name.c_str(), phantom->title.c_str(), options.out.c_str());
  return ExitCode::ok;
}

std::vector<std::string> names() {
  return {echo_phantoms().begin(), echo_phantoms().end()};
}

}  // namespace

void add_phantom_command(Command& image, ExitCode& code) {
  auto options = std::make_shared<PhantomCommandOptions>();
  Command* command = add_command(
      image, "phantom", "A standard test object through the same engine, with what it must show",
      "homogeneous: speckle statistics, attenuation   points: resolution, slice thickness\n"
      "cyst: lumen, enhancement, edge shadows         layers: interface levels, displayed depths\n"
      "needle: brightness by angle, rings, shadow\n"
      "Examples:\n"
      "  artus image phantom points --out out/points\n"
      "  artus image phantom needle --needle-angle 30 --gauge 20 --out out/needle\n"
      "  artus image phantom cyst --transducer curved-2-5 --depth 80 --out out/cyst --json");
  command->add_option("name", options->name, "homogeneous, points, cyst, layers or needle")
      ->required()
      ->one_of(names());
  add_imaging_options(command, options->view);
  command
      ->add_option("--needle-angle", options->needle_angle_deg,
                   "of the needle phantom, degrees to the face")
      ->capture_default_str();
  command
      ->add_option("--needle-depth", options->needle_depth_mm,
                   "of the needle phantom below the middle of the face, mm")
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "folder for the results")->required();
  command->add_flag("--json", options->json, "print the ground truth as JSON");
  on_run(command, code, [options] { return run_phantom(*options); });
}

}  // namespace artus
