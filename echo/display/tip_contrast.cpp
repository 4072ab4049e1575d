// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/tip_contrast.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

constexpr double kDisc = 0.75e-3;  // m, radius
constexpr double kInner = 2e-3;    // m
constexpr double kOuter = 4e-3;    // m

struct Power {
  double sum = 0;
  int n = 0;
  void add(double amplitude) {
    sum += amplitude * amplitude;
    ++n;
  }
};

}  // namespace

std::optional<double> tip_contrast(const Frame& frame, const Transducer& transducer, double x,
                                   double z) noexcept {
  Power disc;
  Power ring;
  const Vec3 tip(x, 0, z);
  for (int i = 0; i < frame.n_lines; ++i) {
    const Scanline line = scanline(transducer, i);
    const double along = (tip - line.origin).dot(line.direction);
    const double aside = (tip - line.origin - along * line.direction).norm();
    if (aside > kOuter) continue;
    const int first = std::max(0, static_cast<int>((along - kOuter) / frame.sample_depth));
    const int last =
        std::min(frame.n_samples - 1, static_cast<int>((along + kOuter) / frame.sample_depth));
    const float* samples = frame.envelope.data() + static_cast<std::ptrdiff_t>(i) * frame.n_samples;
    for (int k = first; k <= last; ++k) {
      const double off = std::hypot(aside, k * frame.sample_depth - along);
      if (off <= kDisc) disc.add(static_cast<double>(samples[k]));
      if (off >= kInner && off <= kOuter) ring.add(static_cast<double>(samples[k]));
    }
  }
  if (disc.n == 0 || ring.n == 0 || ring.sum <= 0) return std::nullopt;
  return 10 * std::log10(std::max(disc.sum / disc.n, 1e-30) / (ring.sum / ring.n));
}

std::optional<double> tip_contrast(const Frame& frame, const Transducer& transducer) noexcept {
  if (!frame.tip_shown) return std::nullopt;
  const double left = -0.5 * frame.pixel * frame.width;
  const double x = left + (frame.tip_shown->x + 0.5) * frame.pixel;
  const double top = std::min(0.0, scanline(transducer, 0).origin.z());
  const double z = top + (frame.tip_shown->y + 0.5) * frame.pixel;
  return tip_contrast(frame, transducer, x, z);
}

}  // namespace artus
