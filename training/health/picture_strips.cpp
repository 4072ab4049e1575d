// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/picture_strips.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace artus {
namespace {

constexpr double kDarkest = -60;      // dB, what a picture shows as black
constexpr double kSmoothed = 0.5e-3;  // m along a scanline
constexpr double kFlat = 1;           // dB, standard deviation of a line that shows nothing
constexpr double kFarMore = 4;        // times the median's unlikeness
constexpr double kLeast = 0.2;        // of unlikeness

/// One line as it is shown, each sample the mean of those around it.
std::vector<double> smoothed_line(const Frame& frame, int line, std::size_t first) {
  const auto n = static_cast<std::size_t>(frame.n_samples);
  const std::span<const float> all(frame.decibel);
  const auto samples = all.subspan(static_cast<std::size_t>(line) * n, n);
  const auto half = static_cast<std::size_t>(kSmoothed / frame.sample_depth / 2);
  std::vector<double> sums(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i)
    sums[i + 1] = sums[i] + std::clamp(static_cast<double>(samples[i]), kDarkest, 0.0);
  std::vector<double> out;
  for (std::size_t i = first; i < n; ++i) {
    const std::size_t low = i > half ? i - half : 0;
    const std::size_t high = std::min(n, i + half + 1);
    out.push_back((sums[high] - sums[low]) / static_cast<double>(high - low));
  }
  return out;
}

/// Less its mean, over its norm; empty when it shows nothing.
std::vector<double> normed(std::vector<double> line) {
  const auto n = static_cast<double>(line.size());
  double mean = 0;
  for (const double v : line) mean += v / n;
  double square = 0;
  for (double& v : line) {
    v -= mean;
    square += v * v;
  }
  if (!(square > kFlat * kFlat * n)) return {};
  for (double& v : line) v /= std::sqrt(square);
  return line;
}

}  // namespace

std::vector<double> neighbour_likeness(const Frame& frame, double from) {
  const auto first = static_cast<std::size_t>(from / frame.sample_depth);
  std::vector<double> likeness;
  std::vector<double> before;
  for (int line = 0; line < frame.n_lines; ++line) {
    const bool touches =
        frame.contact.empty() || frame.contact[static_cast<std::size_t>(line)] > 0.5F;
    std::vector<double> now;
    if (touches) now = normed(smoothed_line(frame, line, first));
    if (line > 0) {
      double sum = 0;
      for (std::size_t i = 0; i < std::min(now.size(), before.size()); ++i)
        sum += now[i] * before[i];
      const bool shown = !now.empty() && !before.empty();
      likeness.push_back(shown ? sum : std::numeric_limits<double>::quiet_NaN());
    }
    before = std::move(now);
  }
  return likeness;
}

double share_of_strips(const std::vector<double>& likeness) {
  std::vector<double> unlike;
  for (const double c : likeness)
    if (std::isfinite(c)) unlike.push_back(1 - c);
  if (unlike.empty()) return 0;
  const auto middle = unlike.begin() + static_cast<std::ptrdiff_t>(unlike.size() / 2);
  std::nth_element(unlike.begin(), middle, unlike.end());
  const double limit = std::max(kLeast, kFarMore * *middle);
  const auto strips =
      std::count_if(unlike.begin(), unlike.end(), [limit](double u) { return u > limit; });
  return static_cast<double>(strips) / static_cast<double>(unlike.size());
}

}  // namespace artus
