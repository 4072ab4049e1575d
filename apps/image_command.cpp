// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/detail/apps/options/press_options.h"
#include "artus/detail/apps/options/sight.h"
#include "artus/detail/apps/options/view_options.h"
#include "artus/detail/apps/options/window_options.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/dataset/echo_truth.h"
#include "artus/detail/echo/display/rf_lines.h"
#include "artus/detail/echo/display/scan_converter.h"
#include "artus/detail/echo/display/seen_structures.h"
#include "artus/detail/exchange/line_file.h"
#include "artus/detail/reports/views_page.h"
#include "artus/echo/image_io.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

struct ImageOptions {
  JointOptions joint;
  ViewOptions view;
  PressOptions press;
  std::filesystem::path out;
  std::filesystem::path envelope;
  std::filesystem::path rf;
  bool plain = false;
  std::optional<double> doppler_mm_s;
  bool doppler_power = false;
  double doppler_time_s = 0.125;
  double doppler_limit_cm_s = 10;
  bool json = false;
  std::string language;
};

/// The picture that the flags ask for.
cv::Mat picture_of(const Frame& frame, const View& view, const ImageOptions& options) {
  const cv::Mat picture =
      options.doppler_mm_s
          ? doppler_image(frame, ScanConverter(view.transducer, view.settings), view.settings,
                          options.doppler_power ? MotionShown::power : MotionShown::velocity)
          : grey_image(frame);
  return options.plain ? picture : annotated_image(picture, frame, view.transducer);
}

/// Whether the lines before the envelope can be had, when they are asked for.
Result<void> check_lines(const View& view, const ImageOptions& options) {
  if (options.rf.empty()) return {};
  ARTUS_TRY(line_file_of(options.rf, "--rf"));
  return check_single_lines(view.settings);
}

/// Writes them.
Result<void> write_lines(const Frame& frame, const View& view, const ImageOptions& options) {
  if (options.rf.empty()) return {};
  const auto file = line_file_of(options.rf, "--rf");
  ARTUS_TRY(file);
  const auto lines = make_rf_lines(frame, view.transducer, view.settings);
  ARTUS_TRY(lines);
  const auto bytes = file->encode(*lines);
  ARTUS_TRY(bytes);
  return write_text(options.rf, *bytes);
}

ExitCode run_image(const ImageOptions& options) {
  auto loaded = load_view(options.joint, options.view, options.json);
  if (!loaded) return report_error(loaded.error(), options.json);
  if (const auto possible = check_lines(loaded->view, options); !possible)
    return report_error(possible.error(), options.json);
  const auto pressed = press(*loaded, options.press);
  if (!pressed) return report_error(pressed.error(), options.json);
  View& view = loaded->view;
  if (options.doppler_mm_s) {
    view.settings.doppler = true;
    view.settings.doppler_limit = 0.01 * options.doppler_limit_cm_s;
    if (loaded->needle)
      loaded->needle->v_JN =
          *options.doppler_mm_s * kMillimetre * loaded->needle->X_JN.linear().col(2);
  }
  Renderer renderer(loaded->scene, view.transducer, view.settings);
  if (options.doppler_mm_s) renderer.set_flow_time(options.doppler_time_s);
  const Frame& frame = renderer.render(loaded->X_JP, loaded->needle);
  if (const auto sight = check_sight(frame, *loaded); !sight)
    return report_error(sight.error(), options.json);

  const cv::Mat image = picture_of(frame, view, options);
  if (const auto written = write_image(image, options.out); !written)
    return report_error(written.error(), options.json);
  if (!options.envelope.empty())
    if (const auto written = write_envelope(frame, options.envelope); !written)
      return report_error(written.error(), options.json);
  if (const auto written = write_lines(frame, view, options); !written)
    return report_error(written.error(), options.json);

  const std::vector<std::string> notes = notes_of_stand(*loaded);
  if (options.json) {
    nlohmann::json report{{"joint", loaded->joint().name},
                          {"image", options.out.string()},
                          {"width_px", image.cols},
                          {"height_px", image.rows},
                          {"pixel_mm", frame.pixel / kMillimetre},
                          {"probe", probe_json(loaded->X_JP)},
                          {"contact", contact_json(frame)},
                          {"notes", notes},
                          {"transducer", to_json(view.transducer)},
                          {"settings", to_json(view.settings)}};
    if (loaded->needle)
      report["needle"] =
          to_json(locate_needle(*loaded->needle, loaded->X_JP, view.transducer, view.settings),
                  frame.tip_shown);
    if (!pressed->is_null()) report["press"] = *pressed;
    if (!options.envelope.empty()) report["envelope"] = options.envelope.string();
    if (!options.rf.empty()) report["rf"] = options.rf.string();
    std::cout << report.dump(2) << '\n';
  } else {
    std::printf("%s: %d x %d pixels of %.3f mm\n", options.out.c_str(), image.cols, image.rows,
                frame.pixel / kMillimetre);
    print_press(*pressed);
    for (const std::string& note : notes) std::printf("! %s\n", note.c_str());
  }
  return ExitCode::ok;
}

constexpr const char* kAllViews = "all";

/// One view with its picture.
Result<ShownView> show_view(const ImageOptions& options, const StandardView& view) {
  JointOptions joint = options.joint;
  joint.view = view.name;
  auto loaded = load_view(joint, options.view, true);
  ARTUS_TRY(loaded);
  const View& v = loaded->view;
  Renderer renderer(loaded->scene, v.transducer, v.settings);
  const Frame& frame = renderer.render(loaded->X_JP, loaded->needle);
  const LabelImage labels = render_labels(*loaded->scene, loaded->X_JP, v.transducer, v.settings);
  return ShownView{view, picture_of(frame, v, options), find_seen(labels, loaded->joint(), view)};
}

/// Pictures of all views in a folder, and a page of them.
ExitCode run_all_views(ImageOptions options) {
  options.joint.view.clear();
  const auto joint = load(options.joint, make_progress_printer(options.json));
  if (!joint) return report_error(joint.error(), options.json);
  if ((*joint)->views.empty())
    return report_error({ErrorCode::not_found, "the joint has no views", (*joint)->name},
                        options.json);
  if (const auto made = make_folder(options.out); !made)
    return report_error(made.error(), options.json);
  std::vector<ShownView> all;
  nlohmann::json report = nlohmann::json::array();
  for (const StandardView& view : (*joint)->views) {
    auto shown = show_view(options, view);
    if (!shown) return report_error(shown.error(), options.json);
    const auto file = options.out / (view.name + ".png");
    if (const auto written = write_image(shown->picture, file); !written)
      return report_error(written.error(), options.json);
    nlohmann::json seen = nlohmann::json::array();
    for (const SeenStructure& s : shown->seen)
      seen.push_back({{"structure", s.structure},
                      {"depth_mm", s.depth / kMillimetre},
                      {"share", s.share},
                      {"side", s.side},
                      {"fault", to_sentence(s.fault, Language::english)}});
    report.push_back({{"view", view.name}, {"image", file.string()}, {"seen", std::move(seen)}});
    all.push_back(std::move(*shown));
  }
  const auto page = options.out / "index.html";
  const auto written =
      write_text(page, make_views_page((*joint)->name, all, language_of(options.language)));
  if (!written) return report_error(written.error(), options.json);
  if (options.json)
    std::cout << report.dump(2) << '\n';
  else
    std::printf("%s: %zu views\n", page.c_str(), all.size());
  return ExitCode::ok;
}

}  // namespace

void add_image_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<ImageOptions>();
  Command* command = add_command(
      app, "image", "The B-mode image at a probe pose, with or without a needle",
      "Examples:\n"
      "  artus image -j meshes/simple-shoulder -o bmode.png\n"
      "  artus image -j meshes/shoulder --needle default -o needle.png --envelope envelope.tiff\n"
      "  artus image -j meshes/shoulder --probe=-39.6,-44.2,-5/0.66,0.75,0/0.75,-0.66,0 -o "
      "groove.png\n"
      "  artus image -j meshes/shoulder --view biceps_groove -o groove.png\n"
      "  artus image -j meshes/knee --view all -o views          pictures and a page of them\n"
      "  artus image -j meshes/shoulder --press-n 3 -o pressed.png\n"
      "  artus image -j meshes/shoulder --press-n 2 --needle default --needle-direction in -o "
      "tent.png\n"
      "  artus image -j meshes/shoulder --transducer curved-2-5 --depth 80 -o curved.png\n"
      "  artus image -j meshes/hip --depth 60 --probe=22,-64,15/0,0.9,-0.43/1,0,0 --doppler 0 "
      "--doppler-limit 60 -o vessels.png");
  add_joint_options(command, options->joint);
  add_patient_option(command, options->joint.patient);
  add_view_options(command, options->view);
  add_press_options(command, options->press);
  add_drag_option(command, options->press);
  command
      ->add_option("-o,--out", options->out,
                   "image file (.png, .jpg, .tiff); with --view all a folder")
      ->required();
  command->add_option("--envelope", options->envelope,
                      "also write the envelope before compression (.tiff, 32-bit float)");
  command->add_option(
      "--rf", options->rf,
      "also write the beamformed lines before the envelope (.npz, .uff; docs/rf.md)");
  command->add_flag("--plain", options->plain, "pixels of the sector alone, no depth scale");
  command->add_option(
      "--doppler", options->doppler_mm_s,
      "colour what moves: blood in its vessels, and the needle at this speed toward "
      "its tip, mm/s");
  command->add_flag("--doppler-power", options->doppler_power,
                    "colour how strong its echo is, whichever way it moves");
  command
      ->add_option("--doppler-time", options->doppler_time_s,
                   "s after a heart beat began at which blood is seen (default: systole)")
      ->check(number_in(0, 1e4));
  command
      ->add_option("--doppler-limit", options->doppler_limit_cm_s,
                   "velocity along the beam at which colours wrap round, cm/s (default: 10)")
      ->check(number_in(0.1, 1000));
  command->add_flag("--json", options->json, "machine-readable output");
  add_language_option(command, options->language);
  on_run(command, code, [options] {
    return options->joint.view == kAllViews ? run_all_views(*options) : run_image(*options);
  });
}

}  // namespace artus
