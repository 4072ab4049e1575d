// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/strain_image.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <span>
#include <sstream>

#include "artus/detail/core/check.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Two frames and the sizes of what is matched, in samples.
struct Matcher {
  const Frame& before;
  const Frame& after;
  int window;
  int reach;  // lines to either side
  int search;

  /// Correlation of the piece at `line` and `sample` with the one `shift` samples farther down,
  /// 0..1; 0 where it leaves the picture.
  [[nodiscard]] double correlate(int line, int sample, int shift) const {
    if (sample + shift < 0 || sample + shift + window > before.n_samples) return 0;
    std::complex<double> product = 0;
    double power_a = 0;
    double power_b = 0;
    for (int l = std::max(0, line - reach); l <= std::min(before.n_lines - 1, line + reach); ++l) {
      const auto a = static_cast<std::size_t>(l * before.n_samples + sample);
      const auto b = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(a) + shift);
      for (std::size_t i = 0; i < static_cast<std::size_t>(window); ++i) {
        const std::complex<double> u(before.in_phase[a + i], before.quadrature[a + i]);
        const std::complex<double> v(after.in_phase[b + i], after.quadrature[b + i]);
        product += u * std::conj(v);
        power_a += std::norm(u);
        power_b += std::norm(v);
      }
    }
    const double power = std::sqrt(power_a * power_b);
    return power > 0 ? std::abs(product) / power : 0;
  }

  struct Match {
    double shift = 0;  // samples
    double correlation = 0;
  };
  /// The best shift within `search` of `guess`, between samples by a parabola.
  [[nodiscard]] Match match(int line, int sample, int guess) const {
    int best = guess;
    double peak = -1;
    for (int s = guess - search; s <= guess + search; ++s) {
      const double c = correlate(line, sample, s);
      if (c > peak) {
        peak = c;
        best = s;
      }
    }
    const double left = correlate(line, sample, best - 1);
    const double right = correlate(line, sample, best + 1);
    const double bend = left - 2 * peak + right;
    const double off = bend < 0 ? std::clamp(0.5 * (left - right) / bend, -0.5, 0.5) : 0;
    return {best + off, peak - 0.25 * (left - right) * off};
  }
};

/// Slope of `values`, `step` apart, by least squares.
double slope_of(std::span<const float> values, double step) {
  const double middle = 0.5 * (static_cast<double>(values.size()) - 1);
  double above = 0;
  double below = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = static_cast<double>(i) - middle;
    above += x * values[i];
    below += x * x;
  }
  return below > 0 ? above / below / step : 0;
}

void fill_strain(StrainImage& image, const StrainParams& params) {
  const int half = std::max(1, static_cast<int>(std::lround(0.5 * params.fit / params.step)));
  image.strain.assign(image.displacement.size(), kUnknown);
  for (int l = 0; l < image.n_lines; ++l) {
    const auto first = static_cast<std::size_t>(l * image.n_depths);
    for (int k = half; k + half < image.n_depths; ++k) {
      const auto begin = first + static_cast<std::size_t>(k - half);
      const auto n = static_cast<std::size_t>(2 * half + 1);
      const auto sure = std::span(image.correlation).subspan(begin, n);
      if (*std::min_element(sure.begin(), sure.end()) < params.min_correlation) continue;
      image.strain[first + static_cast<std::size_t>(k)] =
          static_cast<float>(slope_of(std::span(image.displacement).subspan(begin, n), image.step));
    }
  }
}

}  // namespace

StrainImage compute_strain(const Frame& before, const Frame& after, const StrainParams& params) {
  ARTUS_REQUIRE(before.n_lines == after.n_lines && before.n_samples == after.n_samples,
                "two frames of one size");
  const auto samples = [&](double length) {
    return std::max(1, static_cast<int>(std::lround(length / before.sample_depth)));
  };
  const Matcher matcher{before, after, samples(params.window), params.lines / 2,
                        samples(params.search)};
  const int step = samples(params.step);
  StrainImage image;
  image.n_lines = before.n_lines;
  image.n_depths = std::max(0, (before.n_samples - matcher.window) / step);
  image.step = step * before.sample_depth;
  image.first_depth = 0.5 * matcher.window * before.sample_depth;
  for (int l = 0; l < image.n_lines; ++l) {
    double guess = 0;
    for (int k = 0; k < image.n_depths; ++k) {
      const auto found = matcher.match(l, k * step, static_cast<int>(std::lround(guess)));
      if (found.correlation > params.min_correlation) guess = found.shift;
      image.displacement.push_back(static_cast<float>(found.shift * before.sample_depth));
      image.correlation.push_back(static_cast<float>(found.correlation));
    }
  }
  StrainParams used = params;
  used.step = image.step;
  fill_strain(image, used);
  return image;
}

Result<void> write_strain(const StrainImage& image, const std::filesystem::path& file) {
  std::ostringstream out;
  out << "line,depth_mm,displacement_um,strain_percent,correlation\n";
  for (int l = 0; l < image.n_lines; ++l) {
    for (int k = 0; k < image.n_depths; ++k) {
      const auto i = static_cast<std::size_t>(l * image.n_depths + k);
      out << l << ',' << (image.first_depth + k * image.step) / kMillimetre << ','
          << 1e6F * image.displacement[i] << ',';
      if (!std::isnan(image.strain[i])) out << 100 * image.strain[i];
      out << ',' << image.correlation[i] << '\n';
    }
  }
  return write_text(file, out.str());
}

}  // namespace artus
