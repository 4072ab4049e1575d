// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/echo/realism_gates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "artus/detail/evidence/validation/echo/echo_gates.h"
#include "artus/detail/evidence/validation/echo/echo_patch.h"
#include "artus/detail/evidence/validation/echo/realism_scenes.h"
#include "artus/detail/evidence/validation/echo/screen_measures.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

const char* const kTuned = "the clinical look was tuned in this band";
constexpr double kSteep = 30 * kDegree;         // rad, from which bone counts as steep
constexpr double kSteepestSeen = 60 * kDegree;  // and up to which it is looked at

ClaimBasis tuned() {
  return {ClaimKind::fitted, kTuned};
}

void claim_bone(Gate& gate, const cv::Mat& image, const std::vector<double>& surface,
                double pixel) {
  const BoneLine flat = measure_bone_line(image, surface, pixel, 0, kSteep);
  const BoneLine steep = measure_bone_line(image, surface, pixel, kSteep, kSteepestSeen);
  gate.claims.push_back(claim_at_least(tuned(), "columns with a line, flat", flat.found, 0.97, ""));
  gate.claims.push_back(
      claim_at_least(tuned(), "columns with a line, 30 to 60 degrees", steep.found, 0.9, ""));
  for (const auto& [name, line] : {std::pair("flat", flat), {"30 to 60 degrees", steep}}) {
    gate.claims.push_back(claim_within(tuned(), std::string("thickness, ") + name,
                                       line.thickness / kMillimetre, 1.15, 0.15, "mm"));
    gate.claims.push_back(claim_at_most(tuned(), std::string("unevenness along it, ") + name,
                                        line.evenness, 0.22, ""));
  }
}

void claim_shadow(Gate& gate, const cv::Mat& image, const std::vector<double>& surface,
                  double pixel) {
  constexpr double kBelow = 3e-3;  // m under the surface
  cv::Mat mask = cv::Mat::zeros(image.size(), CV_8UC1);
  for (int x = 0; x < image.cols; ++x) {
    const double row = surface[static_cast<std::size_t>(x)];
    if (row < 0) continue;
    for (int y = static_cast<int>(row + kBelow / pixel); y < image.rows; ++y)
      mask.at<std::uint8_t>(y, x) = 255;
  }
  const std::vector<double> shadow = sorted_grey(image, mask);
  const auto dark =
      static_cast<double>(std::lower_bound(shadow.begin(), shadow.end(), 4.0) - shadow.begin());
  gate.claims.push_back(
      claim_within(tuned(), "shadow's median", sorted_percentile(shadow, 0.5), 15, 5, "grey"));
  gate.claims.push_back(claim_within(tuned(), "shadow's 95th percentile",
                                     sorted_percentile(shadow, 0.95), 30, 10, "grey"));
  gate.claims.push_back(claim_at_most(tuned(), "share of the shadow below 4",
                                      dark / static_cast<double>(shadow.size()), 0.05, ""));
}

/// Mean and deviation of the grey along a shaft, the brightest of three pixels across its near
/// wall, where muscle of a speed of sound (m/s) shows that.
Moments along_shaft(const cv::Mat& image, const ScreenNeedle& needle, double speed) {
  std::vector<double> values;
  for (double along = needle.from; along < needle.to; along += 0.2e-3) {
    Vec3 p = needle.tip - along * needle.axis;
    p.z() -= 0.5 * needle.view.shape.outer_diameter / std::abs(needle.axis.x());
    p.z() *= kDisplaySpeedOfSound / speed;
    const PixelPoint at = needle.pixel_of(p);
    double most = 0;
    for (int k = -1; k <= 1; ++k) {
      const int x = static_cast<int>(std::lround(at.x));
      const int y = static_cast<int>(std::lround(at.y)) + k;
      if (x < 0 || y < 0 || x >= image.cols || y >= image.rows) continue;
      most = std::max(most, static_cast<double>(image.at<std::uint8_t>(y, x)));
    }
    values.push_back(most);
  }
  return moments_of(values);
}

/// Contrast of the shaft: its grey over the same muscle's without it, in deviations of that.
double contrast(double degrees, cv::Mat& picture) {
  const ScreenNeedle needle = make_screen_needle(degrees * kDegree);
  const auto scene = needle_scene();
  ImageSettings settings = screen_settings();
  settings.texture = false;  // the source's phantom is even
  Renderer renderer(scene, Transducer{}, settings);
  const cv::Mat without = grey_image(renderer.render(Pose::Identity())).clone();
  picture = grey_image(renderer.render(Pose::Identity(), needle.view)).clone();
  const cv::Rect around(picture.cols / 2 - 60, 120, 120, 100);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(without(around), mean, deviation);
  const double speed = scene->joint().tissue_of(kFirstRegion).acoustic.speed_of_sound;
  return (along_shaft(picture, needle, speed).mean - mean[0]) / deviation[0];
}

}  // namespace

Gate gate_screen_bone() {
  Gate gate;
  gate.title = "A ball of bone (1280 triangles, radius 14 mm) in muscle, clinical look";
  gate.assumed = {"the share of bone's echo at steep slopes, its line's thickness, the clutter"};
  for (const char* transducer : {"linear-6-18", "linear-4-9"}) {
    const ScreenPicture shown = picture_of_bone(transducer);
    const std::size_t first = gate.claims.size();
    claim_bone(gate, shown.image, shown.surface, shown.pixel);
    claim_shadow(gate, shown.image, shown.surface, shown.pixel);
    for (std::size_t k = first; k < gate.claims.size(); ++k)
      gate.claims[k].text = std::string(transducer) + ": " + gate.claims[k].text;
    add_picture(gate, std::string("bone-") + transducer, shown.image);
  }
  return gate;
}

Gate gate_screen_needle() {
  Gate gate;
  gate.title = "Contrast of a 22 G needle in muscle by its angle ([VanDeBerg2019])";
  gate.assumed = {"the contrast along the face, of which the source's values are shares"};
  struct Measured {
    double degrees;
    double share;
  };
  constexpr std::array<Measured, 5> kMeasured{
      {{10, 0.70}, {15, 0.50}, {20, 0.38}, {30, 0.35}, {50, 0.26}}};
  cv::Mat picture;
  const double flat = contrast(0, picture);
  add_picture(gate, "needle-0", picture);
  for (const Measured& m : kMeasured) {
    const double share = contrast(m.degrees, picture) / flat;
    gate.claims.push_back(claim_within(
        {ClaimKind::fitted, "the brightness by angle is a table"},
        printed("contrast at %.0f degrees over that at 0", m.degrees), share, m.share, 0.15, ""));
    add_picture(gate, printed("needle-%.0f", m.degrees), picture);
  }
  return gate;
}

Gate gate_screen_lumen() {
  Gate gate;
  gate.title = "A lumen of 8 mm in tissue, clinical look: clutter 15 to 30 dB below the tissue";
  gate.assumed = {"levels of side lobes, haze and the receiver's noise"};
  const auto phantom = make_echo_phantom("cyst");
  Renderer renderer(phantom->scene, Transducer{}, screen_settings());
  const Frame& frame = renderer.render(phantom->X_JP);
  const LumenPlace lumen = lumen_of(*phantom);
  const double inside = mean_level(frame, lumen.x, lumen.z, 0.6 * lumen.radius);
  const double beside = mean_level(frame, lumen.x - 2 * lumen.radius, lumen.z, 0.6 * lumen.radius);
  gate.claims.push_back(
      claim_within(tuned(), "lumen over tissue beside it", inside - beside, -22.5, 7.5, "dB"));
  add_picture(gate, "lumen", grey_image(frame).clone());
  return gate;
}

Gate gate_screen_muscle() {
  Gate gate;
  gate.title = "Muscle along its fibres, clinical look";
  gate.assumed = {"grey curve, speckle reduction, sizes of perimysium"};
  for (const Look look : {Look::clinical, Look::compound}) {
    ImageSettings settings = screen_settings();
    settings.look = look;
    const Frame frame = render_bmode(long_axis_muscle(), Pose::Identity(), {}, {}, settings);
    const cv::Mat image = grey_image(frame).clone();
    const cv::Rect patch(image.cols / 2 - 120, 120, 240, 200);
    const std::string name = look_name(look);
    const cv::Mat everywhere(patch.size(), CV_8UC1, cv::Scalar(255));
    const std::vector<double> grey = sorted_grey(image(patch), everywhere);
    gate.claims.push_back(
        claim_at_least(tuned(), name + ": 99th percentile over median",
                       sorted_percentile(grey, 0.99) / sorted_percentile(grey, 0.5), 2.5, ""));
    gate.claims.push_back(claim_at_least(tuned(), name + ": skewness of the finest band",
                                         fine_skewness(image(patch)), 0.1, ""));
    settings.texture = false;
    const Frame even = render_bmode(long_axis_muscle(), Pose::Identity(), {}, {}, settings);
    const cv::Mat grain = grey_image(even).clone();
    const auto width_at = [&](double depth) {
      const int row = static_cast<int>(depth / settings.pixel);
      return measure_patch(grain, {grain.cols / 2 - 150, row - 40, 300, 80}).lateral_width;
    };
    gate.claims.push_back(claim_at_least(tuned(), name + ": grain across, 35 mm over 10 mm",
                                         width_at(35e-3) / width_at(10e-3), 1.15, ""));
    add_picture(gate, "muscle-" + name, image);
  }
  return gate;
}

}  // namespace artus
