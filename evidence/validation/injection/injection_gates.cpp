// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/injection/injection_gates.h"

#include <array>

#include "artus/detail/evidence/validation/injection/injection_gates_list.h"

namespace artus {
namespace {

constexpr std::array<NamedGate, 13> kGates{{{"needle", gate_needle},
                                            {"compliance", gate_compliance},
                                            {"air", gate_air},
                                            {"leak", gate_leak},
                                            {"energy", gate_energy},
                                            {"mass", gate_mass},
                                            {"rates", gate_rates},
                                            {"places", gate_places},
                                            {"hand", gate_hand},
                                            {"loss", gate_loss},
                                            {"aspiration", gate_aspiration},
                                            {"capsule", gate_capsule},
                                            {"bevel", gate_bevel}}};

constexpr GateSet kSet{
    "injection-gates", "The syringe and the places that liquid goes to, against known answers",
    "closed forms of flow and pressure, integrals, an independent model; each gate names its own",
    kGates};

}  // namespace

const GateSet& injection_gates() noexcept {
  return kSet;
}

namespace injection_gate {

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

}  // namespace injection_gate

}  // namespace artus
