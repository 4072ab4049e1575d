// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/injection/injection_gates.h"

#include <array>

#include "artus/core/known_names.h"
#include "artus/evidence/injection/injection_gates_list.h"

namespace artus {
namespace {

using Gate = InjectionGate (*)();

constexpr std::array<std::string_view, 12> kNames{"needle", "compliance", "air",     "leak",
                                                  "energy", "mass",       "rates",   "hand",
                                                  "loss",   "aspiration", "capsule", "bevel"};
constexpr std::array<Gate, kNames.size()> kGates{
    gate_needle, gate_compliance, gate_air,  gate_leak,       gate_energy,  gate_mass,
    gate_rates,  gate_hand,       gate_loss, gate_aspiration, gate_capsule, gate_bevel};

}  // namespace

std::span<const std::string_view> injection_gates() noexcept {
  return kNames;
}

Result<InjectionGate> run_injection_gate(std::string_view name) {
  const auto at = find_name(kNames, name, "gate");
  ARTUS_TRY(at);
  InjectionGate gate = kGates.at(*at)();
  gate.name = name;
  return gate;
}

EvidenceReport report_of(std::span<const InjectionGate> gates) {
  EvidenceReport report;
  report.name = "injection-gates";
  report.title = "The syringe and the places that liquid goes to, against known answers";
  report.source =
      "closed forms of flow and pressure, an independent model; each gate names its own";
  TextTable table{{"gate", "what", "holds"}, {}};
  for (const InjectionGate& gate : gates) {
    table.rows.push_back({gate.name, gate.title, all_hold(gate.claims) ? "yes" : "no"});
    for (Claim claim : gate.claims) {
      claim.text = gate.name + ": " + claim.text;
      report.claims.push_back(std::move(claim));
    }
  }
  report.tables.emplace_back("Gates", std::move(table));
  return report;
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
