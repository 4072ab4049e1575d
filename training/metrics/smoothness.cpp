// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/smoothness.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include <unsupported/Eigen/FFT>

namespace artus {
namespace {

constexpr int kPadding = 4;         // powers of two beyond the signal
constexpr double kHighest = 10;     // Hz
constexpr double kSmallest = 0.05;  // of the largest magnitude

/// Magnitudes from 0 to kHighest, the largest 1.
std::vector<double> spectrum(std::span<const double> speed, double rate, double& step) {
  std::size_t n = 1;
  while (n < speed.size()) n *= 2;
  n <<= kPadding;
  std::vector<double> padded(n, 0.0);
  std::copy(speed.begin(), speed.end(), padded.begin());
  std::vector<std::complex<double>> transform;
  Eigen::FFT<double> fft;
  fft.fwd(transform, padded);
  step = rate / static_cast<double>(n);
  std::vector<double> magnitude;
  double largest = 0;
  for (const auto& value : transform) largest = std::max(largest, std::abs(value));
  for (std::size_t i = 0; i < n && static_cast<double>(i) * step <= kHighest; ++i)
    magnitude.push_back(largest > 0 ? std::abs(transform[i]) / largest : 0);
  return magnitude;
}

}  // namespace

double spectral_arc_length(std::span<const double> speed, double rate) {
  if (speed.size() < 2) return 0;
  double step = 0;
  const std::vector<double> m = spectrum(speed, rate, step);
  const auto loud = [](double value) {
    return value >= kSmallest;
  };
  const auto first = std::find_if(m.begin(), m.end(), loud);
  if (first == m.end()) return 0;
  const auto last = std::find_if(m.rbegin(), m.rend(), loud).base() - 1;
  const auto n = static_cast<double>(last - first);
  double length = 0;
  for (auto i = first; i != last; ++i) length += std::hypot(1 / n, *(i + 1) - *i);
  return -length;
}

double log_dimensionless_jerk(std::span<const double> speed, double rate) {
  if (speed.size() < 3) return 0;
  const double peak = *std::max_element(speed.begin(), speed.end());
  double sum = 0;
  for (std::size_t i = 2; i < speed.size(); ++i) {
    const double jerk = (speed[i] - 2 * speed[i - 1] + speed[i - 2]) * rate * rate;
    sum += jerk * jerk / rate;
  }
  const double duration = static_cast<double>(speed.size()) / rate;
  const double jerk = duration * duration * duration / (peak * peak) * sum;
  return peak > 0 && jerk > 0 ? -std::log(jerk) : 0;
}

}  // namespace artus
