// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/frame_measure.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/check.h"

namespace artus {

ImageSettings raw_settings() {
  ImageSettings settings;
  settings.look = Look::raw;
  return settings;
}

ImageSettings bare_settings() {
  ImageSettings settings = raw_settings();
  settings.tgc_db_cm_mhz = 0;
  settings.noise_db = -300;
  settings.texture = false;
  settings.reverberation = false;
  settings.frequency_downshift = false;
  settings.n_threads = 2;
  return settings;
}

double decibel(double amplitude) {
  return 20 * std::log10(amplitude);
}

double decibel_of_intensity(double intensity) {
  return 10 * std::log10(intensity);
}

std::span<const float> envelope_line(const Frame& frame, int line) {
  const auto n = static_cast<std::size_t>(frame.n_samples);
  return {frame.envelope.data() + static_cast<std::size_t>(line) * n, n};
}

double mean_intensity(const Frame& frame, double from, double to) {
  const auto first = static_cast<std::size_t>(from / frame.sample_depth);
  const auto last = static_cast<std::size_t>(to / frame.sample_depth);
  double sum = 0;
  for (int l = 0; l < frame.n_lines; ++l) {
    const auto line = envelope_line(frame, l);
    for (std::size_t i = first; i < last; ++i) sum += static_cast<double>(line[i]) * line[i];
  }
  return sum / (static_cast<double>(last - first) * frame.n_lines);
}

int find_peak(const Frame& frame, int line, double from, double to) {
  const auto all = envelope_line(frame, line);
  const auto first = all.begin() + static_cast<int>(from / frame.sample_depth);
  const auto last = all.begin() + static_cast<int>(to / frame.sample_depth);
  return static_cast<int>(std::max_element(first, last) - all.begin());
}

double peak_value(const Frame& frame, int line, double from, double to) {
  return envelope_line(frame, line)[static_cast<std::size_t>(find_peak(frame, line, from, to))];
}

Moments moments_of(std::span<const double> values) {
  double sum = 0;
  double squares = 0;
  for (const double v : values) {
    sum += v;
    squares += v * v;
  }
  const auto n = static_cast<double>(values.size());
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

LineFit fit_line(std::span<const double> x, std::span<const double> y) {
  ARTUS_REQUIRE(x.size() == y.size() && x.size() >= 2, "x and y must be of one length");
  const Moments mx = moments_of(x);
  const Moments my = moments_of(y);
  double covariance = 0;
  for (std::size_t i = 0; i < x.size(); ++i) covariance += (x[i] - mx.mean) * (y[i] - my.mean);
  covariance /= static_cast<double>(x.size());
  LineFit fit;
  fit.slope = covariance / (mx.deviation * mx.deviation);
  fit.intercept = my.mean - fit.slope * mx.mean;
  fit.correlation = covariance / (mx.deviation * my.deviation);
  return fit;
}

double falls_to(std::span<const double> x, std::span<const double> y, double level) {
  ARTUS_REQUIRE(x.size() == y.size() && !x.empty(), "x and y must be of one length");
  for (std::size_t i = x.size() - 1; i > 0; --i) {
    if (y[i] <= level && y[i - 1] > level) {
      return x[i - 1] + (x[i] - x[i - 1]) * (y[i - 1] - level) / (y[i - 1] - y[i]);
    }
  }
  return x.back();
}

double full_width(std::span<const double> x, std::span<const double> y) {
  return 2 * falls_to(x, y, *std::max_element(y.begin(), y.end()) / 2);
}

double rayleigh_distance(std::vector<double> envelopes) {
  std::sort(envelopes.begin(), envelopes.end());
  double squares = 0;
  for (const double a : envelopes) squares += a * a;
  const auto n = static_cast<double>(envelopes.size());
  const double power = squares / n;
  double distance = 0;
  for (std::size_t i = 0; i < envelopes.size(); ++i) {
    const double expected = 1 - std::exp(-envelopes[i] * envelopes[i] / power);
    distance = std::max({distance, std::abs(expected - static_cast<double>(i) / n),
                         std::abs(expected - static_cast<double>(i + 1) / n)});
  }
  return distance;
}

}  // namespace artus
