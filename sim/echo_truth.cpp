// SPDX-License-Identifier: AGPL-3.0-or-later
#include "sim/echo_truth.h"

#include <algorithm>
#include <map>
#include <vector>

#include "core/units.h"

namespace artus {
namespace {

nlohmann::json triple(const Vec3& v, double unit = 1) {
  return {v.x() / unit, v.y() / unit, v.z() / unit};
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
  // An image that is white in the shadow goes through the converter of every other image.
  constexpr float kWhite = 0;      // dB
  constexpr float kBlack = -1000;  // dB
  constexpr double kHalf = 127;
  const auto n = static_cast<std::size_t>(frame.n_samples);
  std::vector<float> levels(static_cast<std::size_t>(frame.n_lines) * n, kBlack);
  for (std::size_t l = 0; l < static_cast<std::size_t>(frame.n_lines); ++l) {
    const auto from = static_cast<std::size_t>(std::max(0.0F, frame.shadow_from[l]));
    std::fill(levels.begin() + static_cast<std::ptrdiff_t>(l * n + std::min(from, n)),
              levels.begin() + static_cast<std::ptrdiff_t>((l + 1) * n), kWhite);
  }
  std::vector<std::uint8_t> grey(static_cast<std::size_t>(converter.width()) *
                                 static_cast<std::size_t>(converter.height()));
  converter.convert(levels, 0, converter.height(), grey);
  return cv::Mat(converter.height(), converter.width(), CV_8UC1, grey.data()) > kHalf;
}

nlohmann::json to_json(const NeedleTruth& truth) {
  return {{"tip_px", {truth.tip.x, truth.tip.y}},
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
