// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/space_pressure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace artus {
namespace {

constexpr double kBeyondYield = 1.0 / 3;  // of the slope; assumed
constexpr double kSplitPower = -0.2;      // p of a penny-shaped crack at its length: V^(-1/5)
constexpr double kLogRadii = 3.2188758;   // ln 25
constexpr double kAllParted = 3e-6;       // m^3 from which on the whole film is parted; assumed
constexpr double kFirstParted = 2.5e-4;   // m^2, by needle and tent alone; assumed

/// m, of a film around the tip that is parted as far as a lens of the volume reaches.
double mean_gap(const SpaceLaw& law, double volume) noexcept {
  const double share = std::cbrt(std::clamp(volume / kAllParted, 0.0, 1.0));
  const double area = std::max(share * share * law.film_area, kFirstParted);
  return law.film_gap + std::max(volume, 0.0) / std::min(area, law.film_area);
}

double cavity_slope(const SpaceLaw& law, double v) noexcept {
  double slope = 0;
  if (v > law.slack)
    slope = v < law.slack + law.toe ? law.stiffness * (v - law.slack) / law.toe : law.stiffness;
  if (v > law.yield) slope *= kBeyondYield;
  if (v < 0) slope += law.stiffness;  // what is drawn out sucks the walls together
  if (v >= 0 && v < law.suction_volume) slope += law.suction / law.suction_volume;
  return slope;
}

double cavity_pressure(const SpaceLaw& law, double v) noexcept {
  const double straight = std::min(v, law.yield) - law.slack;
  double p = law.rest;
  if (straight > 0)
    p += straight < law.toe ? law.stiffness * straight * straight / (2 * law.toe)
                            : law.stiffness * (straight - law.toe / 2);
  if (v > law.yield) p += kBeyondYield * law.stiffness * (v - law.yield);
  if (v < 0) p += law.stiffness * v;
  if (law.suction > 0 && v < law.suction_volume)
    p -= law.suction * (1 - std::max(v, 0.0) / law.suction_volume);
  return p;
}

}  // namespace

double pressure_of(const SpaceLaw& law, double volume) noexcept {
  switch (law.kind) {
    case SpaceKind::open:
    case SpaceKind::solid:
      return law.rest;
    case SpaceKind::cavity:
      return cavity_pressure(law, volume);
    case SpaceKind::split:
      break;
  }
  const double v = std::max(volume, 0.0);
  if (v <= law.peak_volume) return law.opening + (law.peak - law.opening) * v / law.peak_volume;
  return law.peak * std::pow(v / law.peak_volume, kSplitPower);
}

double opening_of(const SpaceLaw& law, double volume) noexcept {
  // A split is not there before it is opened: its curve begins at what that takes.
  return law.kind == SpaceKind::split ? std::max(law.opening, pressure_of(law, volume))
                                      : pressure_of(law, volume) + law.opening;
}

double slope_of(const SpaceLaw& law, double volume) noexcept {
  if (law.kind == SpaceKind::cavity) return cavity_slope(law, volume);
  if (law.kind != SpaceKind::split || volume < 0) return 0;
  const double v = volume;
  if (v <= law.peak_volume) return (law.peak - law.opening) / law.peak_volume;
  return kSplitPower * pressure_of(law, v) / v;
}

double film_resistance(const SpaceLaw& law, double volume, double viscosity) noexcept {
  if (!(law.film_area > 0)) return 0;
  const double h = mean_gap(law, volume);
  return 6 * viscosity * kLogRadii / (std::numbers::pi * h * h * h);
}

}  // namespace artus
