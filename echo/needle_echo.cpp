// SPDX-License-Identifier: AGPL-3.0-or-later
#include "echo/needle_echo.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace artus {
namespace {

constexpr double kRingLobe = 14;     // degrees from perpendicular within which the bore rings
constexpr double kFirstRing = 0.4;   // assumed: of the shaft's echo
constexpr double kRingDecay = 0.62;  // assumed: per round trip in the bore
constexpr int kMaxRings = 24;
constexpr double kFaceReflection = 0.1;  // assumed: as in propagation
constexpr double kTipEcho = 0.09;        // assumed: -21 dB, the bevel's edge seen from any side
constexpr double kShadow = 0.8;          // assumed: share of the blocked aperture that is lost
constexpr double kSteepest = 6;          // slope beyond which a shaft is as good as upright
constexpr double kSigmaPerWidth = 1 / 2.3548200450309493;

void add_echo(double sample, double amplitude, std::span<float> line) {
  if (!(sample >= 0) || sample >= static_cast<double>(line.size()) - 1) return;
  const auto i = static_cast<std::size_t>(sample);
  const auto t = static_cast<float>(sample - static_cast<double>(i));
  const auto a = static_cast<float>(amplitude);
  line[i] += (1 - t) * a;
  line[i + 1] += t * a;
}

}  // namespace

/// Where the needle comes nearest to a scanline.
struct NeedleEcho::Place {
  double along = 0;       // m from the tip toward the hub
  double lateral = 0;     // m beside the line
  double elevation = 0;   // m off the plane
  double depth = 0;       // m along the beam, of the axis
  double slope = 0;       // change of depth over change of lateral place, along the line of sight
  double sine = 0;        // of the angle between needle and face
  double end_extent = 0;  // m, half the needle's lateral extent where it only crosses the plane
};

NeedleEcho::NeedleEcho(const NeedleView& needle, const Pose& X_JP, const Transducer& transducer,
                       const BeamShape& shape) noexcept
    : shape_(&shape),
      needle_(needle.shape),
      pitch_(transducer.pitch()),
      pulse_sigma_(transducer.pulse_cycles * transducer.wavelength() / 2 * kSigmaPerWidth) {
  const Pose X_PN = X_JP.inverse() * needle.X_JN;
  p_PTip_ = X_PN.translation();
  axis_P_ = -X_PN.linear().col(2).normalized();
}

NeedleEcho::Place NeedleEcho::find_place(const Scanline& line, const Pose& X_JP,
                                         const BeamPath& path) const noexcept {
  const Vec3 across(line.direction.z(), 0, -line.direction.x());
  const Vec3 tip = p_PTip_ - line.origin;
  const double du = axis_P_.dot(across);
  const double dy = axis_P_.y();
  const double dt = axis_P_.dot(line.direction);
  const double radius = std::max(needle_.outer_diameter / 2, pitch_ / 2);
  Place place;
  double shift = 0;  // m, lateral displacement of the bent beam
  for (int i = 0; i < 3; ++i) {
    const double width = shape_->profile().elevation_width(std::max(0.0, place.depth));
    const double wu = 1 / (radius * radius);
    const double wy = 1 / std::pow(width * kSigmaPerWidth, 2);
    const double u0 = tip.dot(across) - shift;
    const double denominator = du * du * wu + dy * dy * wy;
    const double best = denominator > 1e-3 ? -(u0 * du * wu + tip.y() * dy * wy) / denominator : 0;
    place.along = std::clamp(best, 0.0, needle_.length);
    place.slope = denominator > 1e-3 ? std::abs(dt * du * wu / denominator) : 0;
    place.lateral = u0 + place.along * du;
    place.elevation = tip.y() + place.along * dy;
    place.depth = tip.dot(line.direction) + place.along * dt;
    const Vec3 bent_P = X_JP.inverse() * path.at(std::max(0.0, place.depth)) - line.origin;
    shift = bent_P.dot(across);
  }
  place.sine = std::abs(dt);
  const double flat = std::hypot(du, dy);
  place.end_extent =
      flat > 1e-6 ? needle_.outer_diameter / 2 * std::abs(dy) / flat : needle_.outer_diameter / 2;
  return place;
}

/// How much of the shaft's echo a line hears when the shaft lies `y` beside its plane: the
/// elevation profile convolved with the shaft's width, 1 for a shaft on the axis.
double NeedleEcho::elevation_share(double y, double z) const noexcept {
  const double r = needle_.outer_diameter / 2;
  double sum = 0;
  double centred = 0;
  for (const double offset : {-0.8, -0.4, 0.0, 0.4, 0.8}) {
    sum += shape_->profile().elevation_amplitude(y + offset * r, z);
    centred += shape_->profile().elevation_amplitude(offset * r, z);
  }
  return std::min(1.0, sum / centred);
}

/// The shaft's near wall on one line. A steep shaft passes several samples between two lines: its
/// echo is spread over them, and raised by what the blur of line and pulse takes from a slope, so
/// that needle_reflectivity alone says how bright it is.
void NeedleEcho::add_shaft(const Place& place, double sample, double amplitude,
                           std::span<float> line) const noexcept {
  const double slope = std::min(place.slope, kSteepest);
  const double sigma = shape_->profile().lateral_width(place.depth) * kSigmaPerWidth;
  const double raise = std::hypot(1.0, slope * sigma / pulse_sigma_);
  const int n = std::max(1, static_cast<int>(std::lround(pitch_ * slope / shape_->sample_depth())));
  for (int k = 0; k < n; ++k) {
    add_echo(sample + k - 0.5 * (n - 1), amplitude * raise / n, line);
  }
}

void NeedleEcho::add(const Scanline& line, const Pose& X_JP, const BeamTrace& trace,
                     const BeamPath& path, std::span<float> re,
                     std::span<float> im) const noexcept {
  if (!trace.contact) return;
  const Place place = find_place(line, X_JP, path);
  const double coverage =
      std::clamp((place.end_extent + pitch_ - std::abs(place.lateral)) / pitch_, 0.0, 1.0);
  if (coverage <= 0 || place.depth <= 0) return;
  const double share = elevation_share(place.elevation, place.depth);
  if (share < 1e-4) return;
  const double radius = needle_.outer_diameter / 2;
  const double beside = std::min(1.0, place.lateral * place.lateral / (radius * radius));
  const double to_surface = std::min(
      radius * std::sqrt(1 - beside) / std::sqrt(std::max(0.1, 1 - place.sine * place.sine)),
      place.depth);
  double sample = 0;
  double log_gain = 0;
  if (!trace.find_sample(place.depth - to_surface, sample, log_gain)) return;

  const double width = shape_->profile().elevation_width(place.depth);
  const double on_axis = shape_->profile().elevation_amplitude(place.elevation, place.depth);
  const double blocked =
      kShadow * coverage * on_axis * std::min(1.0, needle_.outer_diameter / width);
  const double sample_depth = shape_->sample_depth();
  const auto below = static_cast<std::size_t>(
      std::min(sample + needle_.outer_diameter / sample_depth, static_cast<double>(re.size())));
  const auto dim = static_cast<float>(1 - blocked);
  for (std::size_t i = below; i < re.size(); ++i) {
    re[i] *= dim;
    im[i] *= dim;
  }

  const double angle = std::asin(std::min(1.0, place.sine));
  const double heard = coverage * share * std::exp(log_gain);
  const double shaft = heard * needle_reflectivity(needle_, angle);
  add_shaft(place, sample, shaft, re);
  add_echo(2 * sample, shaft * shaft * kFaceReflection, re);
  if (place.along < 1e-3) {  // the last millimetre: the bevel's edges
    add_echo(sample, heard * kTipEcho, im);
  }
  const double off = angle / kDegree / kRingLobe;
  double ring = shaft * kFirstRing * std::exp(-off * off);
  const double pitch = reverberation_pitch(needle_) / sample_depth;
  for (int k = 1; k <= kMaxRings && ring > 1e-9; ++k) {
    add_echo(sample + k * pitch, ring, re);
    ring *= kRingDecay;
  }
}

}  // namespace artus
