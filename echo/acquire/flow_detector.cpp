// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/flow_detector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "artus/detail/echo/acquire/doppler.h"

namespace artus {
namespace {

constexpr double kLongest = 0.5;    // s; frames further apart tell of no motion
constexpr float kHeard = 1.6e-4F;   // -76 dB after time gain, a packet's worth. assumed
constexpr double kPacket = 0.4e-3;  // m of depth that one estimate takes. assumed

/// Where what lies at `sample` of a run was at rest, m.
Vec3 rest_at(const BeamTrace& trace, const BeamRun& run, double sample) noexcept {
  if (run.n_knots == 0) return run.p_J + (sample - run.begin) * run.step_J;
  const double share = (sample - run.begin) / std::max(1e-9, run.end - run.begin);
  const double path = run.path_begin + share * (run.path_end - run.path_begin);
  std::size_t k = run.first_knot;
  while (k + 2 < run.first_knot + run.n_knots && trace.knots[k + 1].path < path) ++k;
  const BeamKnot& a = trace.knots[k];
  const BeamKnot& b = trace.knots[std::min(k + 1, run.first_knot + run.n_knots - 1)];
  const double at = (path - a.path) / std::max(1e-9, b.path - a.path);
  return a.rest_J + at * (b.rest_J - a.rest_J);
}

std::span<float> row(std::vector<float>& data, std::size_t l, std::size_t n) {
  return std::span(data).subspan(l * n, n);
}

}  // namespace

FlowDetector::FlowDetector(const Transducer& transducer, const ImageSettings& settings,
                           const BeamShape& shape)
    : shape_(&shape),
      n_lines_(static_cast<std::size_t>(transducer.n_lines)),
      n_samples_(static_cast<std::size_t>(settings.n_samples)),
      speckle_(std::pow(10.0, settings.speckle_db / 20)),
      limit_(settings.doppler_limit) {
  if (!settings.doppler) return;
  re_.resize(n_lines_ * n_samples_);
  im_.resize(n_lines_ * n_samples_);
  has_blood_.resize(n_lines_);
  rest_.resize(n_lines_);
  rest_before_.resize(n_lines_);
  direction_J_.resize(n_lines_, Vec3::UnitZ());
}

void FlowDetector::begin_frame(std::optional<double> time) noexcept {
  before_ = time_;
  time_ = re_.empty() ? std::nullopt : time;
  std::swap(rest_, rest_before_);
}

void FlowDetector::note(int l, const BeamTrace& trace, std::span<const RegionAcoustics> regions,
                        double coupling) noexcept {
  if (!time_) return;
  const auto at = static_cast<std::size_t>(l);
  note_tissue(trace, rest_[at]);
  has_blood_[at] = 0;
  if (trace.n_runs > 0) direction_J_[at] = trace.runs[0].direction_J;
  const auto re = row(re_, at, n_samples_);
  const auto im = row(im_, at, n_samples_);
  for (std::size_t i = 0; i < trace.n_runs;) {
    const RegionId region = trace.runs[i].region;
    std::size_t end = i + 1;
    while (end < trace.n_runs && trace.runs[end].region == region) ++end;
    const RegionAcoustics& acoustics = regions[region];
    if (acoustics.vessel) {
      if (has_blood_[at] == 0) std::fill(re.begin(), re.end(), 0.0F);
      if (has_blood_[at] == 0) std::fill(im.begin(), im.end(), 0.0F);
      has_blood_[at] = 1;
      add_blood(trace, std::span(trace.runs).subspan(i, end - i), *acoustics.vessel,
                coupling * speckle_ * acoustics.backscatter, {re, im});
    }
    i = end;
  }
}

void FlowDetector::note_tissue(const BeamTrace& trace, RestRow& rest) const noexcept {
  rest.fill(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  if (!trace.contact) return;
  const double spacing = static_cast<double>(n_samples_) / kNodes;
  for (std::size_t i = 0; i < trace.n_runs; ++i) {
    const BeamRun& run = trace.runs[i];
    if (run.region == kOutside) continue;
    const double first = std::max(0.0, std::ceil(run.begin / spacing - 0.5));
    for (double k = first; k < kNodes && (k + 0.5) * spacing < run.end; ++k)
      rest[static_cast<std::size_t>(k)] = rest_at(trace, run, (k + 0.5) * spacing);
  }
}

void FlowDetector::add_blood(const BeamTrace& trace, std::span<const BeamRun> runs,
                             const Vessel& vessel, double amplitude,
                             EchoSpan blood) const noexcept {
  const double begin = runs.front().begin;
  const double end = runs.back().end;
  if (!(end > begin)) return;
  const BeamRun& half = runs[runs.size() / 2];
  const Vec3 axis = vessel.direction(rest_at(trace, half, 0.5 * (half.begin + half.end)));
  const double along = axis.dot(half.direction_J);
  // Across a round tube the profile along a chord is a parabola; how high depends on how far from
  // the axis the chord passes, which its length tells.
  const double chord =
      (runs.back().p_J + (end - runs.back().begin) * runs.back().step_J - runs.front().p_J).norm();
  const double across2 = 0.25 * chord * chord * (1 - along * along);
  const double top = std::min(1.0, across2 / (vessel.radius * vessel.radius));
  const double toward = -vessel.middle_speed(*time_) * along * top;
  const double middle = 0.5 * (begin + end);
  for (const BeamRun& run : runs) {
    const double last = std::min(run.end, static_cast<double>(n_samples_) - 1);
    for (double s = std::max(0.0, std::ceil(run.begin)); s <= last; ++s) {
      const double share = (s - run.begin) / std::max(1e-9, run.end - run.begin);
      const double gain = run.log_gain_begin + share * (run.log_gain_end - run.log_gain_begin);
      const double u = 2 * (s - middle) / (end - begin);
      const double velocity = toward * std::max(0.0, 1 - u * u);
      if (!may_show_motion(std::abs(velocity), limit_)) continue;
      const double power = amplitude * amplitude * std::exp(2 * gain);
      const double phase = std::numbers::pi * velocity / limit_;
      blood.re[static_cast<std::size_t>(s)] = static_cast<float>(power * std::cos(phase));
      blood.im[static_cast<std::size_t>(s)] = static_cast<float>(power * std::sin(phase));
    }
  }
}

bool FlowDetector::tissue_velocity(std::size_t l,
                                   std::array<float, kNodes>& toward) const noexcept {
  toward.fill(0);
  const double dt = time_ && before_ ? *time_ - *before_ : 0;
  if (!(dt > 0 && dt < kLongest)) return false;
  bool moves = false;
  for (std::size_t k = 0; k < kNodes; ++k) {
    // At one depth other tissue comes past: that which was farther along the beam comes nearer.
    const Vec3 past = rest_[l][k] - rest_before_[l][k];
    if (!past.allFinite()) continue;
    const double velocity = past.dot(direction_J_[l]) / dt;
    if (!may_show_motion(std::abs(velocity), limit_)) continue;
    toward[k] = static_cast<float>(velocity);
    moves = true;
  }
  return moves;
}

void FlowDetector::colour(std::span<const float> time_gain, BlockWorkers& workers,
                          Frame& frame) const {
  if (!time_) return;
  workers.for_blocks(static_cast<int>(n_lines_), [&](int, int first, int last) {
    for (int l = first; l < last; ++l) colour_line(l, time_gain, frame);
  });
}

void FlowDetector::colour_line(int l, std::span<const float> time_gain, Frame& frame) const {
  const auto at = static_cast<std::size_t>(l);
  const double middle = 0.5 * shape_->sample_depth() * static_cast<double>(n_samples_);
  const auto beside = static_cast<std::size_t>(
      std::max(1.0, 0.5 * shape_->profile().lateral_width(middle) / shape_->line_spacing(middle)));
  const std::size_t from = at - std::min(at, beside);
  const std::size_t to = std::min(n_lines_ - 1, at + beside);
  const bool blood = std::any_of(has_blood_.begin() + static_cast<std::ptrdiff_t>(from),
                                 has_blood_.begin() + static_cast<std::ptrdiff_t>(to) + 1,
                                 [](char has) { return has != 0; });
  std::array<float, kNodes> toward{};
  const bool flash = tissue_velocity(at, toward);
  if (!blood && !flash) return;
  const auto half =
      static_cast<std::size_t>(std::max(1.0, std::round(0.5 * kPacket / shape_->sample_depth())));
  const double share = 1.0 / static_cast<double>((to - from + 1) * (2 * half + 1));
  const auto spacing = static_cast<double>(n_samples_) / kNodes;
  const auto end = std::min(n_samples_, static_cast<std::size_t>(frame.shadow_from[at]));
  const auto column = [&](std::size_t s, double sign, double& re, double& im) {
    for (std::size_t k = from; k <= to; ++k) {
      if (has_blood_[k] == 0) continue;
      re += sign * re_[k * n_samples_ + s];
      im += sign * im_[k * n_samples_ + s];
    }
  };
  double re = 0;
  double im = 0;
  if (blood)
    for (std::size_t s = 0; s < std::min(half, n_samples_); ++s) column(s, 1, re, im);
  for (std::size_t s = 0; s < end; ++s) {
    if (blood && s + half < n_samples_) column(s + half, 1, re, im);
    if (blood && s > half) column(s - half - 1, -1, re, im);
    const std::size_t i = at * n_samples_ + s;
    if (!std::isnan(frame.velocity[i])) continue;
    const auto node =
        std::min(kNodes - 1, static_cast<std::size_t>((static_cast<double>(s)) / spacing));
    const double tg2 = static_cast<double>(time_gain[s]) * time_gain[s];
    const double heard = share * std::hypot(re, im) * tg2;
    double power = 0;
    double velocity = toward[node];
    if (blood && heard > static_cast<double>(kHeard) * kHeard) {
      power = heard;
      velocity += std::atan2(im, re) / std::numbers::pi * limit_;
    } else if (toward[node] != 0) {
      const double echo =
          frame.in_phase[i] * frame.in_phase[i] + frame.quadrature[i] * frame.quadrature[i];
      if (echo * tg2 > static_cast<double>(kColourThreshold) * kColourThreshold) power = echo * tg2;
    }
    if (power <= 0) continue;
    const double wrapped = wrap_velocity(velocity, limit_);
    frame.velocity[i] = static_cast<float>(wrapped);
    frame.motion_db[i] = static_cast<float>(10 * std::log10(power));
  }
}

}  // namespace artus
