// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "artus/detail/apps/hands/hands_commands.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/devices/kit/camera_calibration.h"
#include "artus/detail/devices/kit/marker_fit.h"

namespace artus {
namespace {

struct CameraOptions {
  PictureOptions pictures;
  double ruler_mm = 100;
  double block_mm = 50;
  std::string hand = "right";
};

Result<void> calibrate(CameraOptions options) {
  const double scale = options.ruler_mm / 100;
  options.pictures.phase_s = 600;  // it ends by itself
  std::unique_ptr<kit::CameraCalibration> camera;
  std::string told;
  ARTUS_TRY(for_phases(
      options.pictures,
      {{"hold the board before the camera, still for a moment in each place, tilted to all sides",
        0}},
      [&](std::size_t /*phase*/, const kit::Picture8& picture) {
        if (!camera)
          camera =
              std::make_unique<kit::CameraCalibration>(picture.grey.cols, picture.grey.rows, scale);
        if (camera->take(picture.grey)) tell(printed("  picture %d taken", camera->pictures()));
        const std::string missing = camera->missing();
        if (missing != told && !missing.empty()) tell("  " + missing);
        told = missing;
        return camera->pictures() < 40 && !(missing.empty() && camera->pictures() >= 20);
      }));
  if (!camera) return fail(ErrorCode::invalid, "there was no picture", "source");
  auto lens = camera->solve();
  ARTUS_TRY(lens);
  kit::MeasuredKit fresh =
      kit::make_kit(options.hand == "left" ? kit::Hand::left : kit::Hand::right, scale,
                    options.block_mm * kMillimetre);
  fresh.kit.lens = *lens;
  fresh.has_camera = true;
  ARTUS_TRY(write_text(options.pictures.kit, to_toml(fresh)));
  tell(printed("focal length %.1f pixels, +- %.2f %%, of %d pictures (%d tilted)", lens->fx,
               100 * lens->focal_error, camera->pictures(), camera->tilted()));
  tell("what was measured of markers, tip and face before is to be measured again");
  return {};
}

Result<void> fit_glued(const PictureOptions& options) {
  constexpr double kTurning = 30;  // s
  auto measured = kit_of(options.kit);
  ARTUS_TRY(measured);
  if (!measured->has_camera)
    return fail(ErrorCode::invalid, "calibrate the camera first", options.kit.string());
  std::vector<std::vector<kit::SeenMarker>> pictures[2];  // NOLINT(*-avoid-c-arrays)
  Result<void> sized;
  ARTUS_TRY(for_phases(options,
                       {{"turn the probe slowly before the camera, about all its axes", kTurning},
                        {"turn the syringe slowly before the camera", kTurning}},
                       [&](std::size_t phase, const kit::Picture8& picture) {
                         sized = check_size(measured->kit.lens, picture.grey);
                         if (sized) pictures[phase].push_back(kit::see_markers(picture.grey));
                         return sized.has_value();
                       }));
  ARTUS_TRY(sized);
  for (const std::size_t k : {0U, 1U}) {
    kit::MarkerBody& body = k == 0 ? measured->kit.probe : measured->kit.syringe;
    const kit::MarkerBody drawn =
        k == 0 ? kit::make_probe_body(measured->scale) : kit::make_syringe_body(measured->scale);
    auto fit = kit::fit_markers(drawn, pictures[k], measured->kit.lens);
    ARTUS_TRY(fit);
    body = fit->body;
    tell(
        printed("%s: markers up to %.2f mm from where they are drawn; %.2f pixels before, %.2f now",
                body.name.c_str(), fit->moved / kMillimetre, fit->before, fit->after));
  }
  measured->has_markers = true;
  return write_text(options.kit, to_toml(*measured));
}

ExitCode show_state(const std::filesystem::path& file) {
  const auto measured = kit_of(file);
  if (!measured) return report_error(measured.error(), false);
  const kit::Kit& kit = measured->kit;
  const double error = std::hypot(kit.tip_error, kit.face_error);
  tell(printed("camera=%d markers=%d tip=%d face=%d error_mm=%.1f focal_percent=%.2f hand=%s",
               measured->has_camera ? 1 : 0, measured->has_markers ? 1 : 0,
               measured->has_tip ? 1 : 0, measured->has_face ? 1 : 0, error / kMillimetre,
               100 * kit.lens.focal_error, kit.hand == kit::Hand::left ? "left" : "right"));
  return ExitCode::ok;
}

}  // namespace

void add_calibration_commands(Command& app, ExitCode& code) {
  auto camera = std::make_shared<CameraOptions>();
  Command* command = add_command(
      app, "calibrate", "The camera, from pictures of the board (board.pdf) under glass",
      "Pictures are taken by themselves, where they differ from those before. Most must be\n"
      "tilted by 25 to 45 degrees. Begins a new kit file.\n"
      "Examples:\n"
      "  artus hands calibrate webcam -k hands.toml\n"
      "  artus hands calibrate pictures/ -k hands.toml --ruler-mm 99.2 --hand left");
  add_picture_options(command, camera->pictures, "webcam, webcam:NUMBER, a video or a folder");
  command->add_option("--ruler-mm", camera->ruler_mm, "what the prints' ruler of 100 mm measures")
      ->check(number_in(80, 125))
      ->capture_default_str();
  command->add_option("--block-mm", camera->block_mm, "height of the block on the sheet")
      ->check(number_in(0, 300))
      ->capture_default_str();
  command->add_option("--hand", camera->hand, "that holds the syringe")
      ->one_of({"right", "left"})
      ->capture_default_str();
  on_run(command, code, [camera] { return calibrate(*camera); });

  auto markers = std::make_shared<PictureOptions>();
  command = add_command(app, "markers", "Where the markers were glued, by turning each body",
                        "Needs the camera's calibration. Glue decides: 0.3 mm and 0.7 degrees\n"
                        "off would cost the tip more than a millimetre.\n"
                        "Examples:\n"
                        "  artus hands markers webcam -k hands.toml\n"
                        "  artus hands markers probe.mp4 syringe.mp4 -k hands.toml");
  add_picture_options(command, *markers, "webcam, or two files: probe, syringe");
  on_run(command, code, [markers] { return fit_glued(*markers); });

  auto file = std::make_shared<std::filesystem::path>();
  command = add_command(app, "state", "What of a kit was measured, in one line",
                        "Examples:\n  artus hands state -k hands.toml");
  command->add_option("--kit,-k", *file, "file of the kit's measures")->required();
  on_run(command, code, [file] { return show_state(*file); });
}

}  // namespace artus
