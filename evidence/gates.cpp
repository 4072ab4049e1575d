// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/gates.h"

#include "artus/core/known_names.h"

namespace artus {

Result<Gate> run_gate(const GateSet& set, std::string_view name) {
  const auto at = find_name(item_names(set.gates), name, "gate");
  ARTUS_TRY(at);
  Gate gate = set.gates[*at].measure();
  gate.name = name;
  return gate;
}

EvidenceReport report_of(const GateSet& set, std::span<const Gate> measured) {
  EvidenceReport report;
  report.name = set.name;
  report.title = set.title;
  report.source = set.source;
  TextTable table{{"gate", "what", "holds"}, {}};
  for (const Gate& gate : measured) {
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
