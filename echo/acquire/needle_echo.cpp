// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/needle_echo.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/acquire/point_echo.h"
#include "artus/detail/echo/probe/gain_ramp.h"
#include "artus/detail/echo/probe/gaussian.h"
#include "artus/echo/transducer.h"

namespace artus {
namespace {

constexpr double kRingLobe = 14;     // degrees from perpendicular within which the bore rings
constexpr double kFirstRing = 0.4;   // assumed: of the shaft's echo
constexpr double kRingDecay = 0.62;  // assumed: per round trip in the bore
constexpr int kMaxRings = 24;
// on screens one sees two or three tapering lines, and a copy at twice the depth of a needle that
// lies flat alone. assumed: from pictures of needles in tissue
constexpr double kScreenRing = 0.36;
constexpr double kScreenDecay = 0.42;
constexpr int kScreenRings = 3;
constexpr double kCopyLobe = 2;         // degrees
constexpr double kScreenCopy = 0.35;    // of the sound that comes back from the face
constexpr double kBevel = 2.7;          // outer diameters long
constexpr double kBevelEcho = 2;        // of the shaft's: its ground faces scatter more
constexpr double kBevelMost = 0.25;     // mirror = 1, of a shaft that lies flat no more than that
constexpr double kTipEcho = 0.09;       // assumed: -21 dB, the bevel's point seen from any side
constexpr double kShadow = 0.8;         // assumed: share of the blocked aperture that is lost
constexpr double kSideLobe = 0.016;     // assumed: -36 dB, of an apodised aperture, both ways
constexpr double kSideLobeFall = 2e-3;  // m beside the echo at which a lobe has halved. assumed
constexpr double kFarthestLobe = 8e-3;  // m
constexpr double kTrackCell = 0.15e-3;  // m of track that scatters as one
constexpr std::uint64_t kTrackSeed = 7;
constexpr std::size_t kShadowStride = 16;  // samples between exact values of the shadow
constexpr double kSteepest = 6;            // slope beyond which a shaft is as good as upright

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
  double covered = 0;     // share of the line's own strip of tissue between the shaft's two ends
};

/// The part of the shaft that lies in the slice, beside one scanline.
struct NeedleEcho::Extent {
  double begin = 0;   // m, lateral
  double end = 0;     // m
  double depth = 0;   // m along the beam, of the shaft's place nearest to the line
  double blocks = 0;  // share of the slice's thickness that the shaft fills there
};

NeedleEcho::NeedleEcho(const NeedleView& needle, const Pose& X_JP, const Transducer& transducer,
                       const BeamShape& shape, Look look) noexcept
    : shape_(&shape),
      needle_(needle.shape),
      on_screen_(look != Look::raw),
      X_PJ_(X_JP.inverse()),
      pitch_(transducer.pitch()),
      pulse_sigma_(transducer.pulse_cycles * transducer.wavelength() / 2 * kSigmaPerWidth),
      f_number_(transducer.f_number),
      max_aperture_(transducer.max_aperture),
      phase_(specular_phase(transducer, kDisplaySpeedOfSound)) {
  const Pose X_PN = X_PJ_ * needle.X_JN;
  p_PTip_ = X_PN.translation();
  axis_P_ = -X_PN.linear().col(2).normalized();
}

NeedleEcho::Place NeedleEcho::find_place(const SoundedLine& sounded) const noexcept {
  const Scanline& line = sounded.placed.line;
  const Vec3& across = sounded.placed.across;
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
    const Vec3 bent_P = X_PJ_ * sounded.path.at(std::max(0.0, place.depth)) - line.origin;
    shift = bent_P.dot(across);
  }
  place.sine = std::abs(dt);
  const double flat = std::hypot(du, dy);
  place.end_extent =
      flat > 1e-6 ? needle_.outer_diameter / 2 * std::abs(dy) / flat : needle_.outer_diameter / 2;
  const double tip_u = tip.dot(across) - shift;
  const double hub_u = tip_u + needle_.length * du;
  const double strip = shape_->line_spacing(std::max(0.0, place.depth));
  const double first = std::max(std::min(tip_u, hub_u) - place.end_extent, -0.5 * strip);
  const double last = std::min(std::max(tip_u, hub_u) + place.end_extent, 0.5 * strip);
  place.covered = std::clamp((last - first) / strip, 0.0, 1.0);
  return place;
}

/// How much of the shaft's echo a line hears when the shaft lies `y` beside its plane: the
/// elevation profile convolved with the shaft's width, 1 for a shaft on the axis.
double NeedleEcho::elevation_share(double y, double z) const noexcept {
  return shape_->profile().elevation_share(y, z, needle_.outer_diameter / 2);
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
    add_point_echo(sample + k - 0.5 * (n - 1), amplitude * raise / n, line);
  }
}

NeedleEcho::Tip NeedleEcho::find_tip(const SoundedLine& sounded) const noexcept {
  const Scanline& line = sounded.placed.line;
  const Vec3& across = sounded.placed.across;
  const BeamTrace& trace = sounded.trace;
  Tip tip;
  if (!trace.contact) return tip;
  const Vec3 p = p_PTip_ - line.origin;
  tip.depth = p.dot(line.direction);
  if (tip.depth <= 0) return tip;
  const Vec3 bent = X_PJ_ * sounded.path.at(tip.depth) - line.origin;
  const double beside = std::abs(p.dot(across) - bent.dot(across));
  const double share = 1 - beside / shape_->line_spacing(tip.depth);
  if (share > 0 && trace.find_sample(tip.depth, tip.sample, tip.log_gain)) tip.share = share;
  return tip;
}

/// The bevel's point: a small reflector at the tip, seen from any side. It lies between two lines,
/// which share it, and is raised by what the beam's width will take from a single line's echo.
void NeedleEcho::add_tip(const Tip& tip, std::span<float> line) const noexcept {
  if (tip.share <= 0) return;
  add_point_echo(tip.sample,
                 kTipEcho * tip.share / shape_->line_share(tip.sample) *
                     elevation_share(p_PTip_.y(), tip.depth) * std::exp(tip.log_gain),
                 line);
}

/// Beside the needle's end, a line still hears it a little, at the end's own distance.
void NeedleEcho::add_side_lobe(const Place& place, const BeamTrace& trace,
                               std::span<float> line) const noexcept {
  const double beside = std::abs(place.lateral) - place.end_extent;
  if (beside > kFarthestLobe) return;
  double sample = 0;
  double log_gain = 0;
  if (!trace.find_sample(std::hypot(place.depth, beside), sample, log_gain)) return;
  const double u = beside / kSideLobeFall;
  const double angle = std::asin(std::min(1.0, place.sine));
  add_point_echo(sample,
                 kSideLobe / (1 + u * u) * elevation_share(place.elevation, place.depth) *
                     reflectivity(angle) * std::exp(log_gain),
                 line);
}

NeedleEcho::Extent NeedleEcho::find_extent(const PlacedLine& placed) const noexcept {
  const Scanline& line = placed.line;
  const Vec3& across = placed.across;
  const Vec3 tip = p_PTip_ - line.origin;
  const double du = axis_P_.dot(across);
  const double dy = axis_P_.y();
  const double dt = axis_P_.dot(line.direction);
  const auto half_slice = [&](double along) {
    const double z = std::max(0.0, tip.dot(line.direction) + along * dt);
    return 0.5 * (shape_->profile().elevation_width(z) + needle_.outer_diameter);
  };
  // where the shaft leaves the slice; its width is taken where the shaft crosses the plane
  double first = 0;
  double last = needle_.length;
  if (std::abs(dy) > 1e-6) {
    const double crossing = -tip.y() / dy;
    const double half = half_slice(std::clamp(crossing, 0.0, needle_.length)) / std::abs(dy);
    first = std::max(first, crossing - half);
    last = std::min(last, crossing + half);
  } else if (std::abs(tip.y()) > half_slice(0)) {
    return {};
  }
  if (first >= last) return {};
  const double u0 = tip.dot(across);
  const double flat = std::hypot(du, dy);
  const double round = 0.5 * needle_.outer_diameter * (flat > 1e-6 ? std::abs(dy) / flat : 1);
  const double nearest = std::abs(du) > 1e-6 ? std::clamp(-u0 / du, first, last) : first;
  Extent extent;
  extent.begin = u0 + du * (du > 0 ? first : last) - round;
  extent.end = u0 + du * (du > 0 ? last : first) + round;
  extent.depth = tip.dot(line.direction) + nearest * dt;
  if (extent.depth <= 0) return {};
  extent.blocks =
      shape_->profile().elevation_amplitude(tip.y() + nearest * dy, extent.depth) *
      std::min(1.0, needle_.outer_diameter / shape_->profile().elevation_width(extent.depth));
  return extent;
}

void NeedleEcho::shade(const PlacedLine& placed, std::span<float> light) const noexcept {
  const Extent extent = find_extent(placed);
  const double sample_depth = shape_->sample_depth();
  const double from = (extent.depth + needle_.outer_diameter) / sample_depth;
  if (extent.blocks <= 0 || !(from < static_cast<double>(light.size()))) return;
  // how much of the aperture that serves depth z looks through the shaft
  const auto passes = [&](std::size_t sample) {
    const double z = static_cast<double>(sample) * sample_depth;
    const double aperture = std::min(z / f_number_, max_aperture_);
    const double half = 0.5 * std::max(pitch_, aperture * (z - extent.depth) / z);
    const double covered = std::min(extent.end, half) - std::max(extent.begin, -half);
    return 1 - kShadow * extent.blocks * std::clamp(covered / (2 * half), 0.0, 1.0);
  };
  apply_ramp<float>({static_cast<std::size_t>(from), light.size(), kShadowStride}, passes,
                    [&](std::size_t i, float share) { light[i] *= share; });
}

void NeedleEcho::add_track(double amplitude, const SoundedLine& sounded,
                           EchoSpan echoes) const noexcept {
  const BeamTrace& trace = sounded.trace;
  if (!trace.contact) return;
  const Place place = find_place(sounded);
  double sample = 0;
  double log_gain = 0;
  if (place.depth <= 0 || std::abs(place.lateral) > pitch_ + place.end_extent ||
      !trace.find_sample(place.depth, sample, log_gain)) {
    return;
  }
  const double heard =
      amplitude * elevation_share(place.elevation, place.depth) * std::exp(log_gain);
  const auto cell = static_cast<std::uint64_t>(place.along / kTrackCell);
  add_point_echo(sample, heard * normal_noise(kTrackSeed, 2 * cell), echoes.re);
  add_point_echo(sample, heard * normal_noise(kTrackSeed, 2 * cell + 1), echoes.im);
}

void NeedleEcho::add(const SoundedLine& sounded, const Tip& tip, EchoSpan echoes) const noexcept {
  const BeamTrace& trace = sounded.trace;
  const std::span<float> re = echoes.re;
  if (!trace.contact) return;
  add_tip(tip, echoes.im);
  const Place place = find_place(sounded);
  if (place.depth <= 0) return;
  const double coverage = std::min(
      place.covered,
      std::clamp((place.end_extent + pitch_ - std::abs(place.lateral)) / pitch_, 0.0, 1.0));
  if (coverage <= 0) return add_side_lobe(place, trace, echoes.im);
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

  const double angle = std::asin(std::min(1.0, place.sine));
  const double heard = coverage * share * std::exp(log_gain);
  double strength = reflectivity(angle);
  if (on_screen_ && place.along < kBevel * needle_.outer_diameter)
    strength = std::max(strength, std::min(kBevelMost, kBevelEcho * strength));
  const double shaft = heard * strength;
  add_shaft(place, sample, shaft, re);
  add_rings(sample, shaft, angle, re);
}

double NeedleEcho::reflectivity(double angle) const noexcept {
  return on_screen_ ? needle_on_screen(needle_, angle)
                    : needle_reflectivity(needle_, angle, phase_);
}

/// What comes later than the shaft: its repeat against the face, the lines that ring in the bore.
void NeedleEcho::add_rings(double sample, double shaft, double angle,
                           std::span<float> line) const noexcept {
  double copy = shaft * shaft * kFaceReflection;
  if (on_screen_) {
    const double flat = angle / kDegree / kCopyLobe;
    copy *= kScreenCopy * std::exp(-flat * flat);
  }
  add_point_echo(2 * sample, copy, line);
  const double off = angle / kDegree / kRingLobe;
  double ring = shaft * (on_screen_ ? kScreenRing : kFirstRing) * std::exp(-off * off);
  const double pitch = reverberation_pitch(needle_) / shape_->sample_depth();
  const int rings = on_screen_ ? kScreenRings : kMaxRings;
  for (int k = 1; k <= rings && ring > 1e-9; ++k) {
    add_point_echo(sample + k * pitch, ring, line);
    ring *= on_screen_ ? kScreenDecay : kRingDecay;
  }
}

}  // namespace artus
