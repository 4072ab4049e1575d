// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "core/units.h"
#include "echo/image_io.h"
#include "echo/labels.h"
#include "echo/renderer.h"

#include "apps/view_options.h"

namespace artus {
namespace {

struct ImageOptions {
  JointOptions joint;
  ViewOptions view;
  std::filesystem::path out;
  std::filesystem::path envelope;
  bool plain = false;
  bool json = false;
};

nlohmann::json needle_json(const NeedleTruth& truth) {
  return {{"tip_px", {truth.tip.x, truth.tip.y}},
          {"tip_offset_mm", truth.tip_offset / kMillimetre},
          {"plane_angle_deg", truth.plane_angle / kDegree},
          {"face_angle_deg", truth.face_angle / kDegree},
          {"in_plane", truth.in_plane}};
}

ExitCode run_image(const ImageOptions& options) {
  const auto view = make_view(options.view);
  if (!view) return report_error(view.error(), options.json);
  const auto joint = load(options.joint, make_progress_printer(options.json));
  if (!joint) return report_error(joint.error(), options.json);
  const auto scene = std::make_shared<const Scene>(*joint);
  const Pose X_JP = view->probe(**joint);
  const auto needle = view->needle(**joint);
  const Frame frame = render_bmode(scene, X_JP, needle, view->transducer, view->settings);

  const cv::Mat image =
      options.plain ? grey_image(frame) : annotated_image(frame, view->transducer);
  if (const auto written = write_image(image, options.out); !written)
    return report_error(written.error(), options.json);
  if (!options.envelope.empty())
    if (const auto written = write_envelope(frame, options.envelope); !written)
      return report_error(written.error(), options.json);

  if (options.json) {
    nlohmann::json report{{"joint", (*joint)->name},
                          {"image", options.out.string()},
                          {"width_px", image.cols},
                          {"height_px", image.rows},
                          {"pixel_mm", frame.pixel / kMillimetre},
                          {"probe_position_mm", to_json_mm(X_JP.translation())}};
    if (needle)
      report["needle"] =
          needle_json(locate_needle(*needle, X_JP, view->transducer, view->settings));
    if (!options.envelope.empty()) report["envelope"] = options.envelope.string();
    std::cout << report.dump(2) << '\n';
  } else {
    std::printf("%s: %d x %d pixels of %.3f mm\n", options.out.c_str(), image.cols, image.rows,
                frame.pixel / kMillimetre);
  }
  return ExitCode::ok;
}

}  // namespace

void add_image_command(CLI::App& app, ExitCode& code) {
  auto options = std::make_shared<ImageOptions>();
  CLI::App* command = add_command(
      app, "image", "The B-mode image at a probe pose, with or without a needle",
      "Examples:\n"
      "  artus image -j meshes/simple-shoulder -o bmode.png\n"
      "  artus image -j meshes/shoulder --needle default -o needle.png --envelope envelope.tiff\n"
      "  artus image -j real.artus --probe=-235,-97,1340/0.9,0.4,0/0,0,1 --depth 50 -o long.png");
  add_joint_options(command, options->joint);
  add_view_options(command, options->view);
  command->add_option("-o,--out", options->out, "image file (.png, .tiff)")->required();
  command->add_option("--envelope", options->envelope,
                      "also write the envelope before compression (.tiff, 32-bit float)");
  command->add_flag("--plain", options->plain, "pixels of the sector alone, no depth scale");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_image(*options); });
}

}  // namespace artus
