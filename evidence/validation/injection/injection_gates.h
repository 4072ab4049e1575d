// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/detail/evidence/gate.h"
#include "artus/detail/haptics/plunger/plunger.h"

/// Gates of the syringe and the places that liquid goes to, one function each; gates.h runs them by
/// name. Cost: below 2 s each.
namespace artus {

[[nodiscard]] Gate gate_needle();      ///< pressure drops, inverse, power law
[[nodiscard]] Gate gate_compliance();  ///< constant pressure into a bursa
[[nodiscard]] Gate gate_air();         ///< stopped plunger with trapped air
[[nodiscard]] Gate gate_leak();        ///< over a yield pressure
[[nodiscard]] Gate gate_energy();      ///< the thumb's work
[[nodiscard]] Gate gate_mass();        ///< volumes under wild thumbs
[[nodiscard]] Gate gate_rates();       ///< 1, 2, 10 kHz against an integral
[[nodiscard]] Gate gate_places();      ///< bundled places against an integral
[[nodiscard]] Gate gate_hand();        ///< thumb's force by target, needle and rate
[[nodiscard]] Gate gate_loss();        ///< loss of resistance, at constant rate and force
[[nodiscard]] Gate gate_aspiration();  ///< time to a flash by gauge
[[nodiscard]] Gate gate_capsule();     ///< pressure and volume of shoulders
[[nodiscard]] Gate gate_bevel();       ///< a tip half in two layers

/// What the gates inject with: 50 ml of water in a barrel of 5 ml's width, 22 G of 50 mm, 3 N to
/// start, 2 N to glide.
namespace injection_gate {
inline constexpr double kMl = 1e-6;                        // m^3
inline constexpr double kMercury = 133.322;                // Pa/mmHg
inline constexpr double kPsi = 6894.757;                   // Pa
inline constexpr double kCompliance = 0.09e-6 / kMercury;  // m^3/Pa, of a bursa at rest
inline constexpr double kRest = 8 * kMercury;              // Pa

[[nodiscard]] PlungerParams water_syringe(double entry_loss);
[[nodiscard]] Space cavity(const std::string& name, double rest, double stiffness);
/// Of one pressure whatever goes in.
[[nodiscard]] Space level(const std::string& name, double pressure);
[[nodiscard]] PlungerInput thumb(double force);
/// Pa s/m^3 of the needle of water_syringe.
[[nodiscard]] double needle_resistance();
}  // namespace injection_gate

}  // namespace artus
