// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>
#include <numbers>

namespace artus {

/// A barrel with its plunger.
struct Syringe {
  double volume = 5e-6;         ///< m^3, when full
  double diameter = 12.06e-3;   ///< m, inside
  double break_loose = 3;       ///< N, to set the stopper moving
  double glide = 2;             ///< N, while it moves
  double ageing = 0.1;          ///< of break_loose, more for each tenfold of seconds at rest
  double compliance = 1e-12;    ///< m^3/Pa of stopper and barrel
  double air = 0;               ///< m^3 that is trapped
  double dead_space = 0.07e-6;  ///< m^3 of hub and needle
  double filled = 5e-6;         ///< m^3 at the start
  [[nodiscard]] double area() const noexcept { return std::numbers::pi * diameter * diameter / 4; }
  /// m^3 by which stopper, barrel and trapped air give way to a gauge pressure (Pa, above a
  /// vacuum): Boyle's law, the air as warm as what is around it.
  [[nodiscard]] double squeezed(double pressure) const noexcept {
    return compliance * pressure + air * pressure / (kAtmosphere + pressure);
  }
  /// Its slope, m^3/Pa.
  [[nodiscard]] double softness(double pressure = 0) const noexcept {
    const double whole = kAtmosphere + pressure;
    return compliance + air * kAtmosphere / (whole * whole);
  }
  /// Pa at which it gives way by `taken` m^3: the inverse of squeezed().
  [[nodiscard]] double pressure_of(double taken) const noexcept {
    if (air == 0) return taken / compliance;
    const double half = (compliance * kAtmosphere + air - taken) / 2;
    const double root = std::sqrt(half * half + compliance * taken * kAtmosphere);
    // The form that does not take alike numbers from each other.
    return half > 0 ? taken * kAtmosphere / (half + root) : (root - half) / compliance;
  }
  static constexpr double kAtmosphere = 101325;  ///< Pa
};

/// The smallest of 1, 2.5, 5, 10, 20 and 50 ml that holds `volume` (m^3), filled with it; the
/// largest, full, when none does. Diameters: [SyrD]; friction, compliance, dead space and ageing:
/// assumed.
[[nodiscard]] Syringe syringe_for(double volume);

}  // namespace artus
