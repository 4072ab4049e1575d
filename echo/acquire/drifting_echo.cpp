// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/drifting_echo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "artus/detail/echo/acquire/doppler.h"
#include "artus/detail/echo/acquire/point_echo.h"

namespace artus {
namespace {

constexpr double kBent = 3e-3;          // m beside its line that a beam is looked for
constexpr double kTailStep = 0.1e-3;    // m
constexpr double kTailFall = 0.871;     // per step: 6 dB in five
constexpr double kColourCell = 0.5e-3;  // m to each side: Doppler's longer pulse. assumed
constexpr double kFaint = 5.6e-3;       // -45 dB, as for tissue that moves

}  // namespace

DriftingEcho::DriftingEcho(const Transducer& transducer, const BeamShape& shape) noexcept
    : shape_(&shape), wavenumber_(4 * std::numbers::pi / transducer.wavelength()) {}

void DriftingEcho::place(std::span<const DriftingPoint> points, const Pose& X_JP,
                         const Transducer& probe) {
  X_PJ_ = X_JP.inverse();
  points_.clear();
  for (const DriftingPoint& point : points)
    points_.push_back(
        {X_PJ_ * point.p_J, X_PJ_.linear() * point.v_J, point.amplitude, point.tail, point.phase});
  sort_by_line(probe);
}

/// Scanlines that pass a point by less than kBent, and one more to each side.
DriftingEcho::LineRange DriftingEcho::lines_beside(const Vec3& p_P,
                                                   const Transducer& probe) noexcept {
  double middle = p_P.x() - p_P.z() * std::tan(probe.steering);  // m along the face
  double half = kBent / std::cos(probe.steering);
  if (probe.radius > 0) {
    const double to_centre = std::hypot(p_P.x(), p_P.z() + probe.radius);
    middle = probe.radius * std::atan2(p_P.x(), p_P.z() + probe.radius);
    half = probe.radius * std::asin(std::min(1.0, kBent / to_centre));
  }
  const auto line_at = [&](double x, double beyond) {
    const double line = (x + probe.width / 2) / probe.pitch() + beyond;
    return static_cast<std::uint32_t>(std::clamp(line, 0.0, static_cast<double>(probe.n_lines)));
  };
  return {line_at(middle - half, -1), line_at(middle + half, 2)};
}

void DriftingEcho::sort_by_line(const Transducer& probe) {
  ranges_.clear();
  begin_.assign(static_cast<std::size_t>(probe.n_lines) + 1, 0);
  for (const Placed& point : points_) {
    ranges_.push_back(lines_beside(point.p_P, probe));
    for (std::uint32_t l = ranges_.back().first; l < ranges_.back().end; ++l) ++begin_[l + 1];
  }
  for (std::size_t l = 1; l < begin_.size(); ++l) begin_[l] += begin_[l - 1];
  at_line_.resize(begin_.back());
  for (std::uint32_t i = 0; i < ranges_.size(); ++i) {
    for (std::uint32_t l = ranges_[i].first; l < ranges_[i].end; ++l) at_line_[begin_[l]++] = i;
  }
  for (std::size_t l = begin_.size() - 1; l > 0; --l) begin_[l] = begin_[l - 1];
  begin_[0] = 0;
}

void DriftingEcho::add(const SoundedLine& sounded, EchoSpan echoes) const noexcept {
  const auto index = static_cast<std::size_t>(sounded.placed.index);
  if (!sounded.trace.contact || begin_[index] == begin_[index + 1]) return;
  const Scanline& line = sounded.placed.line;
  const double tail_samples = kTailStep / shape_->sample_depth();
  double aside = 1e-9;  // m that this beam goes beside its line at the most
  for (std::size_t i = 0; i < sounded.path.size; ++i) {
    const Vec3 bent = X_PJ_ * sounded.path.p_J[i] - line.origin;
    aside = std::max(aside, 1e-9 + std::abs(bent.dot(sounded.placed.across)));
  }
  for (std::uint32_t i = begin_[index]; i < begin_[index + 1]; ++i) {
    const Placed& point = points_[at_line_[i]];
    const Vec3 p = point.p_P - line.origin;
    const double beside = p.dot(sounded.placed.across);
    const double depth = p.dot(line.direction);
    if (depth <= 0 || std::abs(beside) > std::min(kBent, aside + shape_->line_spacing(depth)))
      continue;
    const Vec3 bent = X_PJ_ * sounded.path.at(depth) - line.origin;
    const double off = std::abs(beside - bent.dot(sounded.placed.across));
    const double share = 1 - off / shape_->line_spacing(depth);
    double sample = 0;
    double log_gain = 0;
    if (share <= 0 || !sounded.trace.find_sample(depth, sample, log_gain)) continue;
    double heard = point.amplitude * share / shape_->line_share(sample) *
                   shape_->profile().elevation_amplitude(p.y(), depth) * std::exp(log_gain);
    double phase = point.phase + wavenumber_ * depth;
    add_point_echo(sample, heard * std::cos(phase), echoes.re);
    add_point_echo(sample, heard * std::sin(phase), echoes.im);
    for (double below = kTailStep; below <= point.tail; below += kTailStep) {
      heard *= kTailFall;
      sample += tail_samples;
      phase += 2.4;  // rad, no multiple of a turn: what rings has no phase in common
      add_point_echo(sample, heard * std::cos(phase), echoes.re);
      add_point_echo(sample, heard * std::sin(phase), echoes.im);
    }
  }
}

void DriftingEcho::colour(std::span<const PlacedLine> lines, double limit,
                          Frame& frame) const noexcept {
  const auto n_samples = static_cast<std::size_t>(frame.n_samples);
  for (const Placed& point : points_) {
    if (!may_show_motion(point.v_P.norm(), limit)) continue;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const Scanline& line = lines[l].line;
      const Vec3 p = point.p_P - line.origin;
      const double depth = p.dot(line.direction);
      if (depth <= 0) continue;
      const double half = std::max(kColourCell, 0.5 * shape_->profile().lateral_width(depth));
      if (frame.contact[l] <= 0 || std::abs(p.dot(lines[l].across)) > half) continue;
      if (point.amplitude * shape_->profile().elevation_amplitude(p.y(), depth) < kFaint) continue;
      const double toward = wrap_velocity(-point.v_P.dot(line.direction), limit);
      if (!may_show_motion(std::abs(toward), limit)) continue;
      const double middle = depth / shape_->sample_depth();
      const double reach = kColourCell / shape_->sample_depth();
      const double end =
          std::min(static_cast<double>(frame.shadow_from[l]), static_cast<double>(n_samples) - 1);
      const auto row = std::span(frame.velocity).subspan(l * n_samples, n_samples);
      const auto power = std::span(frame.motion_db).subspan(l * n_samples, n_samples);
      for (double s = std::max(0.0, std::ceil(middle - reach)); s <= std::min(middle + reach, end);
           ++s) {
        float& shown = row[static_cast<std::size_t>(s)];
        if (std::abs(shown) > std::abs(toward)) continue;
        shown = static_cast<float>(toward);
        power[static_cast<std::size_t>(s)] = static_cast<float>(20 * std::log10(point.amplitude));
      }
    }
  }
}

}  // namespace artus
