// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/picture_strips.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace artus {
namespace {

constexpr double kDarkest = -60;    // dB, what a picture shows as black
constexpr double kNearest = 1e-3;   // m of depth
constexpr double kWindow = 5e-3;    // m of depth
constexpr double kBeside = 0.3e-3;  // m
constexpr double kDiffers = 3.5;    // dB

/// dB, of a line's samples from `first` on, as they are shown.
double mean_of(const Frame& frame, std::size_t line, std::size_t first, std::size_t n) {
  const std::size_t start = line * static_cast<std::size_t>(frame.n_samples) + first;
  double sum = 0;
  for (std::size_t i = start; i < start + n; ++i)
    sum += std::clamp(static_cast<double>(frame.decibel[i]), kDarkest, 0.0);
  return sum / static_cast<double>(n);
}

bool touches(const Frame& frame, std::size_t line) {
  return frame.contact.empty() || frame.contact[line] > 0.5F;
}

struct Cells {
  std::size_t all = 0;
  std::size_t strips = 0;
};

/// Adds the lines of one window.
void count(const Frame& frame, std::size_t first, std::size_t n, std::size_t beside, Cells& cells) {
  std::vector<double> means;
  for (std::size_t line = 0; line < static_cast<std::size_t>(frame.n_lines); ++line)
    means.push_back(mean_of(frame, line, first, n));
  for (std::size_t i = beside; i + beside < means.size(); ++i) {
    const double left = means[i - beside];
    const double right = means[i + beside];
    const bool shown =
        touches(frame, i - beside) && touches(frame, i) && touches(frame, i + beside);
    if (!shown || std::max({left, means[i], right}) <= kDarkest) continue;
    ++cells.all;
    if (std::abs(means[i] - (left + right) / 2) > kDiffers) ++cells.strips;
  }
}

}  // namespace

double share_of_strips(const Frame& frame, double pitch) {
  const auto samples = [&frame](double depth) {
    return static_cast<std::size_t>(depth / frame.sample_depth);
  };
  const auto beside = static_cast<std::size_t>(std::max(1.0, std::round(kBeside / pitch)));
  const std::size_t n = std::max<std::size_t>(2, samples(kWindow));
  Cells cells;
  for (std::size_t first = samples(kNearest);
       first + n <= static_cast<std::size_t>(frame.n_samples); first += n / 2)
    count(frame, first, n, beside, cells);
  return cells.all == 0 ? 0 : static_cast<double>(cells.strips) / static_cast<double>(cells.all);
}

}  // namespace artus
