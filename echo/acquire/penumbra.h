// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

#include "artus/detail/echo/probe/placed_line.h"
#include "artus/echo/transducer.h"

namespace artus {

/// Weakens what lies beside bone and gas: a point beside their edge and deeper is seen by the part
/// of the aperture alone that looks past it, so a shadow fades in. Two ways: the square of that
/// part of the aperture. `shadow_from` (n_lines) are the samples behind which each scanline is
/// dark; `line` is scanline `l`. What lies inside a shadow stays dark (assumed: half of the
/// penumbra). Source: geometry of the aperture. Cost: nothing for a line without a shallower shadow
/// in reach. `to_the_end`: what other planes echo inside the line's own shadow is weakened as its
/// edge is.
void add_penumbra(const Transducer& transducer, double sample_depth,
                  std::span<const float> shadow_from, int l, EchoSpan line,
                  bool to_the_end = false) noexcept;

}  // namespace artus
