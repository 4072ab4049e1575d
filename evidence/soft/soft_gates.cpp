// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/soft/soft_gates.h"

#include <array>

#include "artus/evidence/soft/soft_gates_list.h"

namespace artus {
namespace {

using Gate = SoftGate (*)();

constexpr std::array<std::string_view, 11> kNames{"patch",  "uniaxial", "point-force", "cantilever",
                                                  "punch",  "layers",   "volume",      "balance",
                                                  "turned", "bytes",    "wild-hand"};
constexpr std::array<Gate, kNames.size()> kGates{
    gate_patch,  gate_uniaxial, gate_point_force, gate_cantilever, gate_punch,    gate_layers,
    gate_volume, gate_balance,  gate_turned,      gate_bytes,      gate_wild_hand};

}  // namespace

std::span<const std::string_view> soft_gates() noexcept {
  return kNames;
}

Result<SoftGate> run_soft_gate(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) {
      SoftGate gate = kGates[i]();
      gate.name = name;
      return gate;
    }
  }
  std::string all;
  for (const std::string_view known : kNames) {
    all += all.empty() ? "" : ", ";
    all += known;
  }
  return fail(ErrorCode::not_found, "no gate '" + std::string(name) + "'; there are " + all);
}

EvidenceReport report_of(std::span<const SoftGate> gates) {
  EvidenceReport report;
  report.name = "soft-gates";
  report.title = "Mechanics of the tissue that gives way, on blocks with known answers";
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
