// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <memory>

#include <opencv2/imgproc.hpp>

#include "artus/detail/apps/options/press_options.h"
#include "artus/detail/apps/options/sight.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/scan_converter.h"
#include "artus/detail/echo/display/strain_image.h"
#include "artus/detail/raycast/moving_scene.h"
#include "artus/echo/image_io.h"

namespace artus {
namespace {

struct ElastogramOptions {
  JointOptions joint;
  ViewOptions view;
  PressOptions press;
  double more_mm = 0.05;
  double full_percent = 1;
  std::filesystem::path out;
  std::filesystem::path csv;
  bool json = false;
};

/// Strain where a pixel lies; NaN where there is none.
float strain_at(const StrainImage& strain, const Transducer& probe, const Vec3& p) {
  const double line = (p.x() / probe.width + 0.5) * (strain.n_lines - 1);
  const double depth = (p.z() - strain.first_depth) / strain.step;
  const auto l = std::lround(line);
  const auto k = std::lround(depth);
  if (l < 0 || l >= strain.n_lines || k < 0 || k >= strain.n_depths)
    return std::numeric_limits<float>::quiet_NaN();
  return strain.strain[static_cast<std::size_t>(l * strain.n_depths + k)];
}

constexpr int kLinesMatched = 9;       // 1.4 mm of the face, as wide as a matched piece is long
constexpr std::uint8_t kDarkest = 16;  // of 255; below it there is no echo to follow, only shadow

/// Soft red, stiff blue over the grey picture, grey alone where nothing is known: as scanners do.
/// `report` gets the share of the picture that has a colour.
cv::Mat coloured(const Frame& frame, const StrainImage& strain, const View& view, double full,
                 nlohmann::json& report) {
  const ScanConverter converter(view.transducer, view.settings);
  const cv::Mat picture = grey_image(frame);
  cv::Mat lit;
  cv::blur(picture, lit, cv::Size(9, 9));
  cv::Mat shade(frame.height, frame.width, CV_8UC1, cv::Scalar(0));
  cv::Mat known(frame.height, frame.width, CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const float e = strain_at(strain, view.transducer, converter.point_of(x, y));
      if (std::isnan(e) || !converter.inside(x, y) || lit.at<std::uint8_t>(y, x) < kDarkest)
        continue;
      shade.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(-255 * e / full);
      known.at<std::uint8_t>(y, x) = 255;
    }
  }
  report["coloured_percent"] = 100.0 * cv::countNonZero(known) / static_cast<double>(known.total());
  cv::Mat colour;
  cv::applyColorMap(shade, colour, cv::COLORMAP_JET);
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_GRAY2BGR);
  cv::Mat mixed;
  cv::addWeighted(grey, 0.55, colour, 0.45, 0, mixed);
  mixed.copyTo(grey, known);
  return grey;
}

/// Why the picture has no colour, and what to do; empty when it has some.
std::string explain_no_strain(const nlohmann::json& summary) {
  constexpr double kMinColoured = 1;  // percent of the picture
  if (summary["coloured_percent"].get<double>() >= kMinColoured) return {};
  return printed(
      "no strain can be told from these two pictures: their echoes agree by %.2f of 1 in the mean; "
      "press more steadily on skin (--press-n), change --more-mm, or look where there are echoes",
      summary["mean_correlation"].get<double>());
}

/// Mean of the strain that is known, its share, and the mean correlation.
nlohmann::json summary_of(const StrainImage& strain) {
  double sum = 0;
  double correlation = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < strain.strain.size(); ++i) {
    correlation += strain.correlation[i];
    if (std::isnan(strain.strain[i])) continue;
    sum += strain.strain[i];
    ++n;
  }
  const auto all = static_cast<double>(std::max<std::size_t>(1, strain.strain.size()));
  return {{"mean_strain_percent", n > 0 ? 100 * sum / static_cast<double>(n) : 0},
          {"known_percent", 100 * static_cast<double>(n) / all},
          {"mean_correlation", correlation / all}};
}

ExitCode run_elastogram(const ElastogramOptions& options) {
  auto loaded = load_view(options.joint, options.view, options.json);
  if (!loaded) return report_error(loaded.error(), options.json);
  auto body = make_soft_body(loaded->scene->shared_joint(), loaded->X_JP, loaded->view.transducer);
  if (!body) return report_error(body.error(), options.json);
  const auto first = press(*body, loaded->X_JP, options.press);
  if (!first) return report_error(first.error(), options.json);
  PressOptions more;
  more.millimetres = first->press.depth / kMillimetre + options.more_mm;
  const auto second = press(*body, loaded->X_JP, more);
  if (!second) return report_error(second.error(), options.json);

  const View& view = loaded->view;
  MovingScene scenes;
  Renderer renderer(scenes.at(first->tissue), view.transducer, view.settings);
  const Frame before = renderer.render(first->press.X_JP, loaded->needle);
  if (const auto sight = check_sight(before, *loaded); !sight)
    return report_error(sight.error(), options.json);
  renderer.set_scene(scenes.at(second->tissue));
  const Frame& after = renderer.render(second->press.X_JP, loaded->needle);
  StrainParams matched;
  matched.lines = kLinesMatched;
  const StrainImage strain = compute_strain(before, after, matched);

  auto report = summary_of(strain);
  const cv::Mat picture = coloured(before, strain, view, options.full_percent / 100, report);
  if (const std::string why = explain_no_strain(report); !why.empty())
    return report_error({ErrorCode::failed, why, options.out.string()}, options.json);
  if (const auto written =
          write_image(annotated_image(picture, before, view.transducer), options.out);
      !written)
    return report_error(written.error(), options.json);
  if (!options.csv.empty())
    if (const auto written = write_strain(strain, options.csv); !written)
      return report_error(written.error(), options.json);
  report["joint"] = loaded->joint().name;
  report["image"] = options.out.string();
  report["before"] = to_json(first->press);
  report["after"] = to_json(second->press);
  if (options.json)
    std::cout << report.dump(2) << '\n';
  else
    std::printf(
        "%s: %.2f N, then %.2f mm more; mean strain %.2f %%, known in %.0f %% of the picture%s\n",
        options.out.c_str(), first->press.normal_force, options.more_mm,
        report["mean_strain_percent"].get<double>(), report["known_percent"].get<double>(),
        first->press.settled && second->press.settled ? "" : "; the tissue is still moving");
  return ExitCode::ok;
}

}  // namespace

void add_elastogram_command(Command& image, ExitCode& code) {
  auto options = std::make_shared<ElastogramOptions>();
  Command* command = add_command(
      image, "strain",
      "Strain image: how much each piece of tissue gives when pressed a little more",
      "Draws the probe pressed (3 N when nothing is said), presses it a little more, draws again, "
      "and\n"
      "finds the motion from the two pictures' echoes alone. Red gives much, blue gives little.\n"
      "Examples:\n"
      "  artus image strain -j meshes/shoulder -o strain.png --csv strain.csv\n"
      "  artus image strain -j meshes/shoulder --press-n 1 --more-mm 0.1 -o strain.png --json");
  add_joint_options(command, options->joint);
  add_view_options(command, options->view);
  add_press_options(command, options->press);
  command->add_option("--more-mm", options->more_mm, "how much farther the second press goes")
      ->check(number_in(0.01, 2))
      ->capture_default_str();
  command->add_option("--full-percent", options->full_percent, "strain that is full red")
      ->check(number_in(0.1, 50))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "picture (.png)")->required();
  command->add_option("--csv", options->csv, "also write displacement and strain");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_elastogram(*options); });
}

}  // namespace artus
