// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/penumbra.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "artus/detail/echo/probe/gain_ramp.h"

namespace artus {
namespace {

constexpr std::size_t kPenumbraStride = 32;  // samples between exact values
constexpr int kStep = 2;                     // lines between those that are looked at

/// What neighbouring scanlines hide of the aperture of one scanline.
class Horizon {
 public:
  Horizon(const Transducer& transducer, double sample_depth, std::span<const float> shadow_from,
          int l) noexcept
      : transducer_(transducer), sample_depth_(sample_depth), shadow_from_(shadow_from), l_(l) {}

  /// The part of the aperture that sees depth z (m), 0..1.
  [[nodiscard]] double open(double z) const noexcept {
    const double half = 0.5 * std::min(z / transducer_.f_number, transducer_.max_aperture);
    return std::max(0.0, 1 - hidden(z, half, -1) - hidden(z, half, 1));
  }

 private:
  /// Share of the aperture that the lines to one side hide: from the ray that passes nearest to the
  /// middle to the one that passes farthest.
  [[nodiscard]] double hidden(double z, double half, int side) const noexcept {
    const double pitch = transducer_.pitch();
    const double curvature = transducer_.radius > 0 ? 1 / transducer_.radius : 0;
    double nearest = half;
    double farthest = 0;
    for (int k = 1;; k += kStep) {
      const int line = l_ + side * k;
      if (line < 0 || line >= static_cast<int>(shadow_from_.size()) || k * pitch > half) break;
      const double depth = sample_depth_ * shadow_from_[static_cast<std::size_t>(line)];
      if (depth >= z) continue;
      const double enlarge = z / (z - depth);
      const double beside = k * pitch * (1 + curvature * depth) * enlarge;
      nearest = std::min(nearest, beside);
      farthest = std::max(farthest, beside + kStep * pitch * enlarge);
    }
    return std::clamp(std::min(farthest, half) - nearest, 0.0, half) / (2 * half);
  }

  const Transducer& transducer_;
  double sample_depth_;
  std::span<const float> shadow_from_;
  int l_;
};

}  // namespace

void add_penumbra(const Transducer& transducer, double sample_depth,
                  std::span<const float> shadow_from, int l, EchoSpan line,
                  bool to_the_end) noexcept {
  const int reach = static_cast<int>(std::ceil(0.5 * transducer.max_aperture / transducer.pitch()));
  const int first = std::max(0, l - reach);
  const int last = std::min(static_cast<int>(shadow_from.size()), l + reach + 1);
  const auto own = static_cast<std::size_t>(shadow_from[static_cast<std::size_t>(l)]);
  const float shallowest =
      *std::min_element(shadow_from.begin() + first, shadow_from.begin() + last);
  const std::size_t begin =
      static_cast<std::size_t>(shallowest) / kPenumbraStride * kPenumbraStride;
  const std::size_t end =
      std::min(line.size(), own + kPenumbraStride);  // echoes reach beyond a surface
  if (begin >= end) return;
  const Horizon horizon(transducer, sample_depth, shadow_from, l);
  const auto gain_at = [&](std::size_t sample) {
    const double open =
        horizon.open(std::max<double>(1, static_cast<double>(sample)) * sample_depth);
    return open * open;
  };
  const std::size_t strides = (end - begin + kPenumbraStride - 1) / kPenumbraStride;
  apply_ramp<double>(
      {begin, std::min(line.size(), begin + strides * kPenumbraStride), kPenumbraStride}, gain_at,
      [&](std::size_t i, float gain) { scale_sample(line, i, gain); });
  if (!to_the_end) return;
  const auto last_gain = static_cast<float>(gain_at(begin + strides * kPenumbraStride));
  for (std::size_t i = begin + strides * kPenumbraStride; i < line.size(); ++i)
    scale_sample(line, i, last_gain);
}

}  // namespace artus
