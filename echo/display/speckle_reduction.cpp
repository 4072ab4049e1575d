// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/speckle_reduction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "artus/detail/echo/medium/simd.h"

namespace artus {
namespace {

// assumed, all of them: chosen by eye and by the finest band of published pictures
constexpr float kUp = 14;   // dB that a brighter neighbour may pull
constexpr float kDown = 9;  // dB that a darker one may
// shares of the samples beside it along the line, the nearest first, and of the neighbouring lines
// at the face and from kDeep on: all together, with both neighbours, below one
constexpr std::array<float, 3> kAlong{0.13F, 0.11F, 0.05F};
constexpr double kAcross = 0.08;
constexpr double kAcrossDeep = 0.21;
constexpr double kDeep = 40e-3;                // m
constexpr std::size_t kReach = kAlong.size();  // samples

/// A step, kept between -kDown and kUp; in a form that vectorises.
inline float bounded(float step) noexcept {
  return 0.5F * (std::abs(step + kDown) - std::abs(step - kUp) + (kUp - kDown));
}

struct Neighbours {
  const float* here;
  const float* left;
  const float* right;
};

ARTUS_SIMD
void reduce_middle(const Neighbours& at, const float* across, float* out, std::size_t begin,
                   std::size_t end) noexcept {
  for (std::size_t i = begin; i < end; ++i) {
    const float c = at.here[i];
    const float beside = bounded(at.left[i] - c) + bounded(at.right[i] - c);
    float along = 0;
    for (std::size_t k = 0; k < kReach; ++k)
      along += kAlong[k] * (bounded(at.here[i - 1 - k] - c) + bounded(at.here[i + 1 + k] - c));
    out[i] = c + across[i] * beside + along;
  }
}

}  // namespace

SpeckleReduction::SpeckleReduction(int n_samples, double sample_depth) {
  for (int i = 0; i < n_samples; ++i) {
    const double deep = std::min(1.0, i * sample_depth / kDeep);
    across_.push_back(static_cast<float>(kAcross + deep * (kAcrossDeep - kAcross)));
  }
}

void SpeckleReduction::reduce(std::span<const float> decibel, int n_lines, int l,
                              std::span<float> out) const {
  const std::size_t n = out.size();
  const float* here = decibel.data() + static_cast<std::size_t>(l) * n;
  const Neighbours at{here, l > 0 ? here - n : here, l + 1 < n_lines ? here + n : here};
  std::copy_n(here, n, out.data());
  if (n > 2 * kReach) reduce_middle(at, across_.data(), out.data(), kReach, n - kReach);
}

}  // namespace artus
