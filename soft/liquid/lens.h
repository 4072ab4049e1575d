// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>
#include <numbers>

namespace artus {

/// m, radius of the patch that `volume` m^3 opens in a wide space: as its third root, the walls'
/// angle being the same. Fitted: 5 ml open by less than 6 mm.
[[nodiscard]] inline double lens_radius(double volume) noexcept {
  constexpr double kRadius = 29.5e-3;  // m, of kVolume
  constexpr double kVolume = 3e-6;     // m^3
  return kRadius * std::cbrt(volume / kVolume);
}

/// m by which its walls are apart `away` m from the middle: a membrane's h0 (1 - (r/a)^2), whose
/// volume is pi a^2 h0/2.
[[nodiscard]] inline double lens_height(double volume, double away) noexcept {
  const double radius = lens_radius(volume);
  if (!(away < radius)) return 0;
  const double share = away / radius;
  return 2 * volume / (std::numbers::pi * radius * radius) * (1 - share * share);
}

}  // namespace artus
