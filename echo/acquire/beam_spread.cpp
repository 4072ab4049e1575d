// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/beam_spread.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "artus/detail/echo/probe/gain_ramp.h"

namespace artus {
namespace {

constexpr double kUnseen = 0.98;  // gains above this are not worth applying

}  // namespace

BeamSpread::BeamSpread(const Transducer& transducer, double depth, int n_samples)
    : n_lines_(transducer.n_lines),
      reach_(
          std::max(1, static_cast<int>(std::lround(kTwoWayWidth * transducer.wavelength() *
                                                   transducer.f_number * 2 / transducer.pitch())))),
      pitch_(transducer.pitch()),
      curvature_(transducer.radius > 0 ? 1 / transducer.radius : 0),
      step_(depth / (kNodes - 1)),
      stride_(static_cast<std::size_t>((n_samples + kNodes - 2) / (kNodes - 1))),
      place_(static_cast<std::size_t>(n_lines_) * kNodes, Eigen::Vector3f::Zero()),
      bent_(static_cast<std::size_t>(n_lines_), 0) {}

void BeamSpread::note(int line, const BeamPath& path) noexcept {
  Eigen::Vector3f* place = place_.data() + static_cast<std::ptrdiff_t>(line) * kNodes;
  bent_[static_cast<std::size_t>(line)] = path.size > 2 ? 1 : 0;
  std::size_t i = 0;
  for (int k = 0; k < kNodes; ++k) {
    const double z = k * step_;
    while (i + 2 < path.size && z > path.length[i + 1]) ++i;
    const double t = (z - path.length[i]) / (path.length[i + 1] - path.length[i]);
    place[k] = (path.p_J[i] + t * (path.p_J[i + 1] - path.p_J[i])).cast<float>();
  }
}

double BeamSpread::gain(int line, int node) const noexcept {
  const int first = std::max(0, line - reach_);
  const int last = std::min(n_lines_ - 1, line + reach_);
  const auto at = [&](int l) -> const Eigen::Vector3f& {
    return place_[static_cast<std::size_t>(l) * kNodes + static_cast<std::size_t>(node)];
  };
  const double apart = static_cast<double>((at(last) - at(first)).norm());
  const double straight = (last - first) * pitch_ * (1 + curvature_ * node * step_);
  return std::min(1.0, straight / std::max(apart, 1e-9));
}

void BeamSpread::apply(int line, EchoSpan echoes) const noexcept {
  const int first = std::max(0, line - reach_);
  const int last = std::min(n_lines_ - 1, line + reach_);
  if (first == last) return;
  if (bent_[static_cast<std::size_t>(first)] == 0 && bent_[static_cast<std::size_t>(last)] == 0)
    return;
  apply_ramp<float>(
      {0, std::min(echoes.size(), (kNodes - 1) * stride_), stride_, kUnseen},
      [&](std::size_t sample) {
        return sample == 0 ? 1.0 : gain(line, static_cast<int>(sample / stride_));
      },
      [&](std::size_t i, float g) { scale_sample(echoes, i, g); });
}

}  // namespace artus
