// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/speckle_reduction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "artus/detail/echo/medium/simd.h"

namespace artus {
namespace {

// assumed, all of them: chosen by eye and by the finest band of published pictures
constexpr float kUp = 10;             // dB that a brighter neighbour may pull
constexpr float kDown = 5;            // dB that a darker one may
constexpr float kAlongNear = 0.07F;   // share of the samples next to it along the line
constexpr float kAlongFar = 0.09F;    // of those behind them
constexpr double kAcross = 0.10;      // of the neighbouring lines at the face
constexpr double kAcrossDeep = 0.26;  // and from kDeep on
constexpr double kDeep = 40e-3;       // m
constexpr std::size_t kReach = 2;     // samples

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
    const float near = bounded(at.here[i - 1] - c) + bounded(at.here[i + 1] - c);
    const float far = bounded(at.here[i - 2] - c) + bounded(at.here[i + 2] - c);
    out[i] = c + across[i] * beside + kAlongNear * near + kAlongFar * far;
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
