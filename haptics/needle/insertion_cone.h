// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>

#include "artus/detail/core/check.h"

namespace artus {

/// The half angle, rad, within which the needle may change its direction at depth `depth`: 45
/// degrees at the skin, 0 when the needle of `needle_length` is fully in. Source [Alamilla2020]
/// eq. 1.2, numerator and denominator exchanged against the print, which grows with depth against
/// its own text and figure.
[[nodiscard]] ARTUS_REALTIME inline double insertion_cone(double depth,
                                                          double needle_length) noexcept {
  const double d = std::clamp(depth, 0.0, needle_length);
  return std::atan2(needle_length - d, needle_length + d);
}

}  // namespace artus
