// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/core/units.h"
#include "artus/detail/haptics/plunger/plunger.h"

/// A plunger with one place at the tip whose answers are known.
namespace artus::test {

inline constexpr double kMercury = 133.322;                // Pa/mmHg
inline constexpr double kPsi = 6894.757;                   // Pa
inline constexpr double kCompliance = 0.09e-6 / kMercury;  // m^3/Pa of a bursa
inline constexpr double kRest = 8 * kMercury;              // Pa

/// 5 ml of water behind 22 G of 50 mm; 3 N to start, 2 N to glide, no ageing.
inline PlungerParams water_syringe(double entry_loss = NeedleFlow::kEntryLoss) {
  PlungerParams params;
  params.syringe.volume = 50 * kCubicCentimetre;  // longer than any test
  params.syringe.filled = 50 * kCubicCentimetre;
  params.syringe.ageing = 0;
  params.liquid.density = 1000;
  params.entry_loss = entry_loss;
  return params;
}

inline std::vector<Space> one_space(const SpaceLaw& law, const std::string& like = "test") {
  Space space;
  space.name = like;
  space.like = like;
  space.law = law;
  return {space};
}

inline SpaceLaw compliance(double rest, double stiffness) {
  SpaceLaw law;
  law.kind = SpaceKind::cavity;
  law.rest = rest;
  law.stiffness = stiffness;
  return law;
}

/// A place of constant pressure.
inline SpaceLaw level(double pressure) {
  SpaceLaw law;
  law.rest = pressure;
  return law;
}

inline PlungerInput thumb(double force) {
  PlungerInput input;
  input.force = force;
  input.tip[0] = {0, 1};
  return input;
}

}  // namespace artus::test
