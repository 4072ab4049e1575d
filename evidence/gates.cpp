// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/gates.h"

#include "artus/detail/core/known_names.h"

namespace artus {

std::vector<std::string_view> gate_names(const GateSet& set) {
  std::vector<std::string_view> names = item_names(set.gates);
  for (const NamedJointGate& gate : set.joint_gates) names.push_back(gate.name);
  return names;
}

Result<Gate> run_gate(const GateSet& set, std::string_view name,
                      const std::shared_ptr<const CompiledJoint>& joint) {
  const auto at = find_name(gate_names(set), name, "gate");
  ARTUS_TRY(at);
  const bool of_joint = *at >= set.gates.size();
  if (of_joint && !joint)
    return fail(ErrorCode::malformed,
                "gate \"" + std::string(name) + "\" measures a joint: needs -j");
  Gate gate =
      of_joint ? set.joint_gates[*at - set.gates.size()].measure(joint) : set.gates[*at].measure();
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
