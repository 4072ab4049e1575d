// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/echo_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "artus/detail/core/check.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/motion_picture.h"
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
  converter.convert_straight(levels, {grey.data, grey.total()});
  return grey > kMiddle;
}

struct TransducerKey {
  const char* name;
  double Transducer::*member;
  double unit;
};
constexpr double kMegahertz = 1e6;  // Hz
constexpr std::array<TransducerKey, 11> kTransducerKeys{
    {{"width_mm", &Transducer::width, kMillimetre},
     {"radius_mm", &Transducer::radius, kMillimetre},
     {"steering_deg", &Transducer::steering, kDegree},
     {"frequency_mhz", &Transducer::frequency, kMegahertz},
     {"bandwidth", &Transducer::bandwidth, 1},
     {"pulse_cycles", &Transducer::pulse_cycles, 1},
     {"f_number", &Transducer::f_number, 1},
     {"max_aperture_mm", &Transducer::max_aperture, kMillimetre},
     {"elevation_height_mm", &Transducer::elevation_height, kMillimetre},
     {"elevation_focus_mm", &Transducer::elevation_focus, kMillimetre},
     {"transmit_focus_mm", &Transducer::transmit_focus, kMillimetre}}};

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

cv::Mat shadow_mask(const Frame& frame, const ScanConverter& converter, const ShownPlaces* places) {
  constexpr float kHalf = 0.5F;  // share of the sound
  const auto n = static_cast<std::size_t>(frame.n_samples);
  // the sample that shows what truly lies at one of the same line
  const auto shown_of = [&](std::size_t i) {
    if (places == nullptr) return static_cast<double>(i % n);
    return places->sample_of(static_cast<int>(i / n),
                             static_cast<double>(i % n) * frame.sample_depth);
  };
  const auto below = [&](std::size_t i) {
    return shown_of(i) >= frame.shadow_from[i / n];
  };
  const auto dimmed = [&](std::size_t i) {
    const double sample = std::clamp(shown_of(i), 0.0, static_cast<double>(n - 1));
    return frame.needle_light[i - i % n + static_cast<std::size_t>(sample)] < kHalf;
  };
  const cv::Mat full = mask_where(frame, converter, below);
  const cv::Mat needle = mask_where(frame, converter, dimmed);
  return cv::max(full, needle & cv::Scalar(128));
}

cv::Mat doppler_image(const Frame& frame, const ScanConverter& converter,
                      const ImageSettings& settings, MotionShown shown) {
  const std::vector<std::uint8_t> moving = motion_picture(frame, converter, settings, shown);
  cv::Mat out;
  cv::cvtColor(grey_image(frame), out, cv::COLOR_GRAY2BGR);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    if (moving[i] == 0) continue;
    const auto [red, green, blue] = motion_colour(moving[i], shown);
    const auto width = static_cast<std::size_t>(out.cols);
    out.at<cv::Vec3b>(static_cast<int>(i / width), static_cast<int>(i % width)) =
        cv::Vec3b(blue, green, red);
  }
  return out;
}

nlohmann::json to_json(const NeedleTruth& truth, const std::optional<PixelPoint>& tip_shown) {
  nlohmann::json shown;
  if (tip_shown) shown = {tip_shown->x, tip_shown->y};
  return {{"tip_true_px", {truth.tip.x, truth.tip.y}},
          {"tip_shown_px", shown},
          {"tip_in_picture", truth.in_picture},
          {"tip_visible", truth.in_slice && tip_shown.has_value()},
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

nlohmann::json to_json(const Transducer& transducer) {
  nlohmann::json out{{"lines", transducer.n_lines}};
  for (const TransducerKey& key : kTransducerKeys)
    out[key.name] = transducer.*key.member / key.unit;
  return out;
}

Result<Transducer> transducer_of(const nlohmann::json& values) {
  Transducer out;
  if (!values.is_object()) return fail(ErrorCode::malformed, "'transducer' must be an object");
  const auto lines = values.find("lines");
  if (lines == values.end() || !lines->is_number_integer())
    return fail(ErrorCode::malformed, "'lines' must be a whole number", "transducer");
  out.n_lines = lines->get<int>();
  for (const TransducerKey& key : kTransducerKeys) {
    const auto value = values.find(key.name);
    if (value == values.end() || !value->is_number())
      return fail(ErrorCode::malformed, std::string("'") + key.name + "' must be a number",
                  "transducer");
    out.*key.member = value->get<double>() * key.unit;
  }
  ARTUS_TRY(validate(out));
  return out;
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
          {"look", look_name(s.look)},
          {"clutter", s.clutter},
          {"speckle_reduction", s.speckle_reduction},
          {"grain", s.grain},
          {"grey_curve", s.grey_curve.grey},
          {"compound_angles", s.compound_angles},
          {"compound_spread_deg", s.compound_spread / kDegree},
          {"refraction", s.refraction},
          {"reverberation", s.reverberation},
          {"frequency_downshift", s.frequency_downshift},
          {"texture", s.texture},
          {"seed", s.seed}};
}

}  // namespace artus
