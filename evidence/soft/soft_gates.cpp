// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/soft/soft_gates.h"

#include <array>

#include "artus/core/known_names.h"
#include "artus/evidence/soft/soft_gates_list.h"

namespace artus {
namespace {

using Gate = SoftGate (*)();

constexpr std::array<std::string_view, 22> kNames{
    "patch",       "uniaxial",  "point-force", "cantilever",   "punch",     "vessel",
    "convergence", "layers",    "volume",      "balance",      "turned",    "reciprocity",
    "bytes",       "wild-hand", "limb",        "strain-image", "inclusion", "speckle",
    "thinning",    "tent",      "drag",        "packets"};
constexpr std::array<Gate, kNames.size()> kGates{
    gate_patch,        gate_uniaxial,    gate_point_force,     gate_cantilever, gate_punch,
    gate_vessel,       gate_convergence, gate_layers,          gate_volume,     gate_balance,
    gate_turned,       gate_reciprocity, gate_bytes,           gate_wild_hand,  gate_limb,
    gate_strain_image, gate_inclusion,   gate_speckle_pressed, gate_thinning,   gate_tent,
    gate_drag,         gate_packets};

}  // namespace

std::span<const std::string_view> soft_gates() noexcept {
  return kNames;
}

Result<SoftGate> run_soft_gate(std::string_view name) {
  const auto at = find_name(kNames, name, "gate");
  ARTUS_TRY(at);
  SoftGate gate = kGates.at(*at)();
  gate.name = name;
  return gate;
}

EvidenceReport report_of(std::span<const SoftGate> gates) {
  EvidenceReport report;
  report.name = "soft-gates";
  report.title = "Tissue that gives way, on blocks with known answers: mechanics and picture";
  report.source = "closed forms of elasticity; each gate names its own";
  TextTable table{{"gate", "what", "holds"}, {}};
  for (const SoftGate& gate : gates) {
    table.rows.push_back({gate.name, gate.title, all_hold(gate.claims) ? "yes" : "no"});
    for (Claim claim : gate.claims) {
      claim.text = gate.name + ": " + claim.text;
      report.claims.push_back(std::move(claim));
    }
  }
  report.tables.emplace_back("Gates", std::move(table));
  return report;
}

}  // namespace artus
