// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/injection/injection_gates.h"

namespace artus::injection_gate {

PlungerParams water_syringe(double entry_loss) {
  PlungerParams params;
  params.syringe.volume = params.syringe.filled = 50 * kMl;
  params.syringe.ageing = 0;
  params.entry_loss = entry_loss;
  params.grip = 1e9;
  return params;
}

Space cavity(const std::string& name, double rest, double stiffness) {
  Space space;
  space.name = space.like = name;
  space.law.kind = SpaceKind::cavity;
  space.law.rest = rest;
  space.law.stiffness = stiffness;
  return space;
}

Space level(const std::string& name, double pressure) {
  Space space;
  space.name = space.like = name;
  space.law.rest = pressure;
  return space;
}

PlungerInput thumb(double force) {
  PlungerInput input;
  input.force = force;
  input.tip[0] = {0, 1};
  return input;
}

double needle_resistance() {
  const PlungerParams params = water_syringe(0);
  return NeedleFlow(params.needle, params.liquid.viscosity, params.liquid.density, 0).resistance();
}

}  // namespace artus::injection_gate
