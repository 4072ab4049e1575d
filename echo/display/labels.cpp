// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/labels.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core/types.hpp>

#include "artus/detail/core/check.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/shown_places.h"
#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/detail/echo/probe/range_check.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

constexpr std::size_t kMaxIntervals = 128;
constexpr double kInPlaneAngle = 5 * kDegree;  // assumed: beyond it only a dot of the shaft shows

/// Writes the regions along one pixel column.
void label_column(const Scene& scene, const Pose& X_JP, const ScanConverter& converter, int x,
                  LabelImage& labels) {
  const Vec3 top = converter.point_of(x, 0);
  const Vec3 down = labels.pixel * labels.height * Vec3::UnitZ();
  std::array<TissueInterval, kMaxIntervals> intervals;
  const Segment column{X_JP * top, X_JP * Vec3(top + down)};
  const QueryCount count = scene.find_intervals(column, intervals);
  for (std::size_t k = 0; k < count.size; ++k) {
    const int first = static_cast<int>(std::ceil(intervals[k].entry / labels.pixel));
    const int last = static_cast<int>(std::ceil(intervals[k].exit / labels.pixel));
    for (int y = std::max(0, first); y < std::min(labels.height, last); ++y) {
      if (!converter.inside(x, y)) continue;
      labels.regions[static_cast<std::size_t>(y) * static_cast<std::size_t>(labels.width) +
                     static_cast<std::size_t>(x)] = intervals[k].region;
    }
  }
}

/// Where a shaft is in the image, pixels, with room for what bends the sound.
cv::Rect frame_of(const NeedleView& needle, const Pose& X_JP, const ScanConverter& converter) {
  constexpr double kRoom = 4e-3;  // m
  const Vec3 tip = X_JP.inverse() * needle.X_JN.translation();
  const Vec3 hub = X_JP.inverse() * (needle.X_JN * Vec3(0, 0, -needle.shape.length));
  const Vec3 room = Vec3::Constant(kRoom + needle.shape.outer_diameter);
  const PixelPoint first = converter.pixel_of(tip.cwiseMin(hub) - room);
  const PixelPoint last = converter.pixel_of(tip.cwiseMax(hub) + room);
  const auto whole = [](double x, int most) {
    return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(most)));
  };
  const cv::Point from(whole(first.x, converter.width()), whole(first.y, converter.height()));
  const cv::Point to(whole(last.x, converter.width()), whole(last.y, converter.height()));
  return {from, to};
}

std::array<std::uint8_t, 3> base_colour(TissueKind kind) {
  switch (kind) {
    case TissueKind::fat:
      return {236, 206, 110};
    case TissueKind::muscle:
      return {178, 60, 56};
    case TissueKind::tendon:
      return {225, 222, 205};
    case TissueKind::nerve:
      return {240, 230, 60};
    case TissueKind::skin:
      return {226, 168, 140};
    case TissueKind::fluid:
      return {70, 130, 220};
    case TissueKind::bone:
      return {245, 240, 225};
    case TissueKind::plain:
      break;
  }
  return {120, 190, 170};
}

}  // namespace

LabelRenderer::LabelRenderer(const Transducer& transducer, const ImageSettings& settings)
    : converter_(require_valid(transducer), require_valid(settings)),
      profile_(transducer, settings.depth),
      half_pulse_(transducer.pulse_cycles * transducer.wavelength() / 4),
      pixel_(settings.pixel) {}

LabelImage LabelRenderer::empty() const {
  LabelImage labels;
  labels.width = converter_.width();
  labels.height = converter_.height();
  labels.pixel = pixel_;
  const auto size =
      static_cast<std::size_t>(labels.width) * static_cast<std::size_t>(labels.height);
  labels.regions.assign(size, kOutside);
  labels.needle.assign(size, 0);
  return labels;
}

/// Marks pixels that show a place inside the shaft, widened by `more` m, and across the plane by
/// half the slice. `place_P`: of a pixel (x, y) in the sector, m, frame P.
template <class PlaceOf>
void LabelRenderer::mark_needle(const NeedleView& needle, const Pose& X_JP, double more,
                                const PlaceOf& place_P, LabelImage& labels) const {
  const Pose X_NP = needle.X_JN.inverse() * X_JP;
  const double radius = needle.shape.outer_diameter / 2 + more;
  const cv::Rect frame = frame_of(needle, X_JP, converter_);
  for (int y = frame.y; y < frame.y + frame.height; ++y) {
    for (int x = frame.x; x < frame.x + frame.width; ++x) {
      if (!converter_.inside(x, y)) continue;
      const Vec3 p_P = place_P(x, y);
      const Vec3 p_N = X_NP * p_P;
      if (p_N.z() > 0 || p_N.z() < -needle.shape.length) continue;
      const Vec3 off_P = X_NP.linear().transpose() * Vec3(p_N.x(), p_N.y(), 0);
      const double elevation = std::abs(off_P.y()) - profile_.elevation_width(p_P.z()) / 2;
      const double across = std::hypot(off_P.x(), off_P.z());
      if (across <= radius && elevation <= radius)
        labels.needle[static_cast<std::size_t>(y) * static_cast<std::size_t>(labels.width) +
                      static_cast<std::size_t>(x)] = 255;
    }
  }
}

LabelImage LabelRenderer::render(const Scene& scene, const Pose& X_JP,
                                 const std::optional<NeedleView>& needle) const {
  ARTUS_REQUIRE(X_JP.matrix().allFinite(), "the probe's pose is not finite");
  LabelImage labels = empty();
  for (int x = 0; x < labels.width; ++x) label_column(scene, X_JP, converter_, x, labels);
  if (needle)
    mark_needle(
        *needle, X_JP, 0, [&](int x, int y) { return converter_.point_of(x, y); }, labels);
  return labels;
}

LabelImage LabelRenderer::render_shown(const ShownPlaces& places, const Pose& X_JP,
                                       const std::optional<NeedleView>& needle) const {
  LabelImage labels = empty();
  for (int y = 0; y < labels.height; ++y) {
    for (int x = 0; x < labels.width; ++x) {
      if (!converter_.inside(x, y)) continue;
      const ScanConverter::LinePlace at = converter_.line_at(x, y);
      labels.regions[static_cast<std::size_t>(y) * static_cast<std::size_t>(labels.width) +
                     static_cast<std::size_t>(x)] =
          places.region(at.share < 0.5 ? at.line : at.line + 1, at.sample);
    }
  }
  if (!needle) return labels;
  const Pose X_PJ = X_JP.inverse();
  const auto place_P = [&](int x, int y) -> Vec3 {
    const ScanConverter::LinePlace at = converter_.line_at(x, y);
    Vec3 place = places.needle_place(at.line, at.sample);
    if (at.share > 0) place += at.share * (places.needle_place(at.line + 1, at.sample) - place);
    return X_PJ * place;
  };
  mark_needle(*needle, X_JP, half_pulse_, place_P, labels);
  return labels;
}

NeedleTruth LabelRenderer::locate(const NeedleView& needle, const Pose& X_JP) const {
  const Pose X_PN = X_JP.inverse() * needle.X_JN;
  const Vec3 tip = X_PN.translation();
  const Vec3 axis = X_PN.linear().col(2);
  NeedleTruth truth;
  truth.tip = converter_.pixel_of(tip);
  truth.in_picture = converter_.inside(truth.tip);
  truth.tip_offset = tip.y();
  truth.plane_angle = std::asin(std::min(1.0, std::abs(axis.y())));
  truth.face_angle = std::asin(std::min(1.0, std::abs(axis.z())));
  truth.in_slice = std::abs(tip.y()) <= half_slice(tip.z());
  truth.in_plane = truth.plane_angle < kInPlaneAngle && truth.in_slice;
  return truth;
}

double LabelRenderer::half_slice(double depth) const noexcept {
  return profile_.elevation_width(std::max(0.0, depth)) / 2;
}

LabelImage render_labels(const Scene& scene, const Pose& X_JP, const Transducer& transducer,
                         const ImageSettings& settings, const std::optional<NeedleView>& needle) {
  return LabelRenderer(transducer, settings).render(scene, X_JP, needle);
}

NeedleTruth locate_needle(const NeedleView& needle, const Pose& X_JP, const Transducer& transducer,
                          const ImageSettings& settings) {
  return LabelRenderer(transducer, settings).locate(needle, X_JP);
}

LabelImage render_shown_labels(const Renderer& renderer, const Pose& X_JP,
                               const std::optional<NeedleView>& needle) {
  return LabelRenderer(renderer.transducer(), renderer.settings())
      .render_shown(renderer.shown_places(X_JP), X_JP, needle);
}

std::vector<std::array<std::uint8_t, 3>> region_palette(const CompiledJoint& joint) {
  const std::vector<RegionAcoustics> regions = make_region_acoustics(joint, Transducer{});
  std::vector<std::array<std::uint8_t, 3>> palette;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (i < kFirstRegion) {
      palette.push_back({20, 20, 24});
      continue;
    }
    std::array<std::uint8_t, 3> colour = base_colour(regions[i].kind);
    const int shade = static_cast<int>(i * 37 % 5) * 10;  // neighbours of one tissue differ
    for (std::uint8_t& channel : colour) {
      channel = static_cast<std::uint8_t>(std::max(0, static_cast<int>(channel) - shade));
    }
    palette.push_back(colour);
  }
  return palette;
}

}  // namespace artus
