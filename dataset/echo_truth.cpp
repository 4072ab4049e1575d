// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/dataset/echo_truth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "artus/core/check.h"
#include "artus/core/units.h"
#include "artus/echo/image_io.h"

namespace artus {
namespace {

nlohmann::json triple(const Vec3& v, double unit = 1) {
  return {v.x() / unit, v.y() / unit, v.z() / unit};
}

/// 255 at the pixels whose samples fulfil `condition`, which is asked for each (line, sample).
template <class Condition>
cv::Mat mask_where(const Frame& frame, const ScanConverter& converter, const Condition& condition) {
  // An image that is white where the condition holds goes through the converter of all images.
  constexpr float kWhite = 0;      // dB
  constexpr float kBlack = -1000;  // dB
  constexpr double kMiddle = 127;
  std::vector<float> levels(frame.envelope.size());
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = condition(i) ? kWhite : kBlack;
  cv::Mat grey(converter.height(), converter.width(), CV_8UC1);
  converter.convert(levels, 0, converter.height(), {grey.data, grey.total()});
  return grey > kMiddle;
}

}  // namespace

cv::Mat id_image(const LabelImage& labels) {
  cv::Mat ids(labels.height, labels.width, CV_16UC1);
  std::copy(labels.regions.begin(), labels.regions.end(), ids.begin<std::uint16_t>());
  return ids;
}

cv::Mat needle_mask(const LabelImage& labels) {
  cv::Mat mask(labels.height, labels.width, CV_8UC1);
  std::copy(labels.needle.begin(), labels.needle.end(), mask.begin<std::uint8_t>());
  return mask;
}

cv::Mat shadow_mask(const Frame& frame, const ScanConverter& converter) {
  constexpr float kHalf = 0.5F;  // share of the sound
  const auto n = static_cast<std::size_t>(frame.n_samples);
  const auto below = [&](std::size_t i) {
    return static_cast<float>(i % n) >= frame.shadow_from[i / n];
  };
  const auto dimmed = [&](std::size_t i) {
    return frame.needle_light[i] < kHalf;
  };
  const cv::Mat full = mask_where(frame, converter, below);
  const cv::Mat needle = mask_where(frame, converter, dimmed);
  return cv::max(full, needle & cv::Scalar(128));
}

cv::Mat doppler_image(const Frame& frame, const ScanConverter& converter,
                      const ImageSettings& settings) {
  ARTUS_REQUIRE(frame.velocity.size() == frame.decibel.size(), "the frame has no velocities");
  // Velocities go through the converter of every other image as greys: -limit is black, limit
  // white, and what stands still is below black.
  constexpr float kStill = -1e6F;  // dB
  std::vector<float> levels(frame.velocity.size());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double v = static_cast<double>(frame.velocity[i]) / settings.doppler_limit;
    levels[i] =
        std::isnan(v) ? kStill : static_cast<float>((v - 1) / 2 * settings.dynamic_range_db);
  }
  cv::Mat moving(frame.height, frame.width, CV_8UC1);
  converter.convert(levels, 0, frame.height, {moving.data, moving.total()});
  cv::Mat out;
  cv::cvtColor(grey_image(frame), out, cv::COLOR_GRAY2BGR);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x) {
      const int grey = moving.at<std::uint8_t>(y, x);
      if (grey == 0) continue;
      const double v = 2 * grey / 255.0 - 1;  // of the limit, toward the probe
      const auto strong = static_cast<std::uint8_t>(110 + 145 * std::abs(v));
      const auto weak = static_cast<std::uint8_t>(140 * std::abs(v));
      out.at<cv::Vec3b>(y, x) = v > 0 ? cv::Vec3b(0, weak, strong) : cv::Vec3b(strong, weak, 0);
    }
  return out;
}

nlohmann::json to_json(const NeedleTruth& truth, const std::optional<PixelPoint>& tip_shown) {
  nlohmann::json shown;
  if (tip_shown) shown = {tip_shown->x, tip_shown->y};
  return {{"tip_px", {truth.tip.x, truth.tip.y}},
          {"tip_shown_px", shown},
          {"tip_offset_mm", truth.tip_offset / kMillimetre},
          {"plane_angle_deg", truth.plane_angle / kDegree},
          {"face_angle_deg", truth.face_angle / kDegree},
          {"in_plane", truth.in_plane}};
}

nlohmann::json region_list(const LabelImage& labels, const CompiledJoint& joint) {
  std::map<RegionId, std::size_t> pixels;
  for (const RegionId region : labels.regions) ++pixels[region];
  const double area = labels.pixel * labels.pixel / (kMillimetre * kMillimetre);
  auto list = nlohmann::json::array();
  for (const auto& [region, count] : pixels)
    list.push_back({{"id", region},
                    {"region", joint.regions[region].name},
                    {"tissue", joint.tissue_of(region).name},
                    {"area_mm2", static_cast<double>(count) * area}});
  return list;
}

nlohmann::json contact_json(const Frame& frame) {
  constexpr float kHalf = 0.5F;
  double sum = 0;
  auto lifted = nlohmann::json::array();
  bool inside = false;
  for (std::size_t l = 0; l < frame.contact.size(); ++l) {
    sum += frame.contact[l];
    const bool lifts = frame.contact[l] < kHalf;
    if (lifts && !inside) lifted.push_back({l, l});
    if (lifts) lifted.back()[1] = l;
    inside = lifts;
  }
  return {{"share", sum / static_cast<double>(std::max<std::size_t>(1, frame.contact.size()))},
          {"lifted_lines", lifted}};
}

nlohmann::json probe_json(const Pose& X_JP) {
  return {{"position_mm", triple(X_JP.translation(), kMillimetre)},
          {"direction", triple(X_JP.linear().col(2))},
          {"lateral", triple(X_JP.linear().col(0))}};
}

nlohmann::json to_json(const Transducer& t) {
  return {{"width_mm", t.width / kMillimetre},
          {"radius_mm", t.radius / kMillimetre},
          {"steering_deg", t.steering / kDegree},
          {"lines", t.n_lines},
          {"frequency_mhz", t.frequency / 1e6},
          {"bandwidth", t.bandwidth},
          {"pulse_cycles", t.pulse_cycles},
          {"f_number", t.f_number},
          {"max_aperture_mm", t.max_aperture / kMillimetre},
          {"elevation_height_mm", t.elevation_height / kMillimetre},
          {"elevation_focus_mm", t.elevation_focus / kMillimetre},
          {"transmit_focus_mm", t.transmit_focus / kMillimetre}};
}

nlohmann::json to_json(const ImageSettings& s) {
  return {{"depth_mm", s.depth / kMillimetre},
          {"samples", s.n_samples},
          {"planes", s.n_planes},
          {"dynamic_range_db", s.dynamic_range_db},
          {"gain_db", s.gain_db},
          {"tgc_db_cm_mhz", s.tgc_db_cm_mhz},
          {"tgc_limit_db", s.tgc_limit_db},
          {"speckle_db", s.speckle_db},
          {"noise_db", s.noise_db},
          {"gel_limit_mm", s.gel_limit / kMillimetre},
          {"pixel_mm", s.pixel / kMillimetre},
          {"persistence", s.persistence},
          {"smoothing", s.smoothing},
          {"compound_angles", s.compound_angles},
          {"compound_spread_deg", s.compound_spread / kDegree},
          {"refraction", s.refraction},
          {"reverberation", s.reverberation},
          {"frequency_downshift", s.frequency_downshift},
          {"texture", s.texture},
          {"seed", s.seed}};
}

}  // namespace artus
