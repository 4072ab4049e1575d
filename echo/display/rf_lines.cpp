// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/rf_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "artus/detail/echo/acquire/line_shaping.h"

namespace artus {
namespace {

constexpr int kSincReach = 16;   // samples to either side that an interpolated one is made of
constexpr double kPerCycle = 4;  // least samples of rf in a cycle of the carrier

/// Weights of the samples around a place `share` (0..1) of the way from one sample to the next: a
/// sinc under a Hann window, of samples -kSincReach + 1 .. kSincReach.
std::vector<float> sinc_weights(double share) {
  std::vector<float> weights;
  for (int k = 1 - kSincReach; k <= kSincReach; ++k) {
    const double x = share - k;
    const double arc = std::numbers::pi * x;
    const double sinc = x == 0 ? 1 : std::sin(arc) / arc;
    weights.push_back(static_cast<float>(sinc * 0.5 * (1 + std::cos(arc / kSincReach))));
  }
  return weights;
}

/// The value of a line at sample `at` plus the share of `weights`; silent beyond its ends.
std::complex<float> value_between(std::span<const std::complex<float>> line, int at,
                                  std::span<const float> weights) {
  std::complex<float> sum = 0;
  const int n = static_cast<int>(line.size());
  for (int k = std::max(1 - kSincReach, -at); k <= std::min(kSincReach, n - 1 - at); ++k)
    sum += weights[static_cast<std::size_t>(k + kSincReach - 1)] *
           line[static_cast<std::size_t>(at + k)];
  return sum;
}

/// Puts a line on its carrier; `phasors` are those of its samples.
void mix_up(std::span<const std::complex<float>> line, std::span<const std::vector<float>> weights,
            std::span<const std::complex<float>> phasors, std::span<float> rf) {
  const std::size_t factor = weights.size();
  for (std::size_t i = 0; i < rf.size(); ++i) {
    const std::size_t at = i / factor;
    const auto value =
        i % factor == 0 ? line[at] : value_between(line, static_cast<int>(at), weights[i % factor]);
    rf[i] = value.real() * phasors[i].real() - value.imag() * phasors[i].imag();
  }
}

void make_rf(RfLines& lines) {
  const auto factor = static_cast<std::size_t>(lines.n_rf_samples / lines.n_samples);
  std::vector<std::vector<float>> weights;
  for (std::size_t k = 0; k < factor; ++k)
    weights.push_back(sinc_weights(static_cast<double>(k) / static_cast<double>(factor)));
  const auto n = static_cast<std::size_t>(lines.n_samples);
  const std::size_t n_rf = n * factor;
  std::vector<std::complex<float>> phasors(n_rf);
  for (std::size_t i = 0; i < n_rf; ++i) {
    const double cycles =
        lines.centre_frequency * static_cast<double>(i) / lines.rf_sampling_frequency;
    phasors[i] = std::complex<float>(std::polar(1.0, 2 * std::numbers::pi * cycles));
  }
  lines.rf.resize(static_cast<std::size_t>(lines.n_lines) * n_rf);
  for (std::size_t l = 0; l < static_cast<std::size_t>(lines.n_lines); ++l)
    mix_up(std::span(lines.iq).subspan(l * n, n), weights, phasors,
           std::span(lines.rf).subspan(l * n_rf, n_rf));
}

void place_lines(const Transducer& transducer, RfLines& lines) {
  for (int l = 0; l < lines.n_lines; ++l) {
    const Scanline line = scanline(transducer, l);
    lines.origins.insert(lines.origins.end(), line.origin.begin(), line.origin.end());
    lines.directions.insert(lines.directions.end(), line.direction.begin(), line.direction.end());
  }
}

}  // namespace

Result<void> check_single_lines(const ImageSettings& settings) {
  if (settings.look == Look::compound || settings.compound_angles > 1)
    return fail(ErrorCode::invalid,
                "a compound picture has no lines of its own before the envelope; take look raw or "
                "clinical and one angle",
                "rf");
  return {};
}

Result<RfLines> make_rf_lines(const Frame& frame, const Transducer& transducer,
                              const ImageSettings& settings) {
  ARTUS_TRY(check_single_lines(settings));
  RfLines lines;
  lines.n_lines = frame.n_lines;
  lines.n_samples = frame.n_samples;
  lines.sample_depth = frame.sample_depth;
  lines.sound_speed = kDisplaySpeedOfSound;
  lines.sampling_frequency = lines.sound_speed / (2 * lines.sample_depth);
  lines.centre_frequency = transducer.frequency;
  lines.bandwidth = transducer.bandwidth;
  const double factor =
      std::max(1.0, std::ceil(kPerCycle * lines.centre_frequency / lines.sampling_frequency));
  lines.rf_sampling_frequency = factor * lines.sampling_frequency;
  lines.n_rf_samples = static_cast<int>(factor) * lines.n_samples;
  lines.face_width = transducer.width;
  lines.face_radius = transducer.radius;
  lines.steering = transducer.steering;
  lines.elevation_height = transducer.elevation_height;
  lines.elevation_focus = transducer.elevation_focus;
  lines.gain_db = settings.gain_db;
  lines.dynamic_range_db = settings.dynamic_range_db;
  lines.time_gain = make_time_gain(transducer, settings);
  lines.iq.resize(frame.in_phase.size());
  for (std::size_t i = 0; i < lines.iq.size(); ++i)
    lines.iq[i] = {frame.in_phase[i], frame.quadrature[i]};
  place_lines(transducer, lines);
  make_rf(lines);
  return lines;
}

std::vector<NamedArray> arrays_of(const RfLines& lines) {
  const auto n_lines = static_cast<std::size_t>(lines.n_lines);
  const auto n_samples = static_cast<std::size_t>(lines.n_samples);
  std::vector<NamedArray> out{
      {"iq", {n_lines, n_samples}, std::span(lines.iq)},
      {"rf", {n_lines, static_cast<std::size_t>(lines.n_rf_samples)}, std::span(lines.rf)},
      {"time_gain", {n_samples}, std::span(lines.time_gain)},
      {"origins", {n_lines, 3}, std::span(lines.origins)},
      {"directions", {n_lines, 3}, std::span(lines.directions)}};
  const auto number = [&](std::string_view name, const double& value) {
    out.push_back({name, {}, std::span(&value, 1)});
  };
  number("sampling_frequency", lines.sampling_frequency);
  number("rf_sampling_frequency", lines.rf_sampling_frequency);
  number("centre_frequency", lines.centre_frequency);
  number("bandwidth", lines.bandwidth);
  number("start_time", lines.start_time);
  number("sound_speed", lines.sound_speed);
  number("sample_depth", lines.sample_depth);
  number("face_width", lines.face_width);
  number("face_radius", lines.face_radius);
  number("steering", lines.steering);
  number("elevation_height", lines.elevation_height);
  number("elevation_focus", lines.elevation_focus);
  number("gain_db", lines.gain_db);
  number("dynamic_range_db", lines.dynamic_range_db);
  return out;
}

}  // namespace artus
