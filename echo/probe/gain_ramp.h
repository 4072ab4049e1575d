// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cstddef>

namespace artus {

/// The samples [begin, end) of a line whose gain changes slowly: it is computed at every
/// `stride`-th sample and runs straight in between.
struct GainRamp {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t stride = 1;
  double unseen = 1;  ///< a stride whose gains both reach this is left alone
};

/// Calls apply(i, gain) for the samples of the ramp, ascending; gain_at(sample) is also asked for
/// the node behind the last sample. Number: what the straight pieces are computed in, float where
/// the last bit does not matter. Cost: one gain_at a stride.
template <class Number, class GainAt, class Apply>
void apply_ramp(const GainRamp& ramp, const GainAt& gain_at, const Apply& apply) {
  if (ramp.begin >= ramp.end) return;
  double next = gain_at(ramp.begin);
  for (std::size_t from = ramp.begin; from < ramp.end; from += ramp.stride) {
    const double here = next;
    next = gain_at(from + ramp.stride);
    if (here >= ramp.unseen && next >= ramp.unseen) continue;
    const auto first = static_cast<Number>(here);
    const auto step = static_cast<Number>((next - here) / static_cast<double>(ramp.stride));
    const std::size_t n = std::min(ramp.stride, ramp.end - from);
    for (std::size_t i = 0; i < n; ++i) {
      apply(from + i, static_cast<float>(first + static_cast<Number>(i) * step));
    }
  }
}

}  // namespace artus
