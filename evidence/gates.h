// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/evidence/report.h"

namespace artus {

struct CompiledJoint;

/// What was measured of something, against what.
struct Gate {
  std::string name;
  std::string title;  ///< what is measured, and where the bound comes from
  std::vector<Claim> claims;
};

struct NamedGate {
  std::string_view name;
  Gate (*measure)();  ///< deterministic; leaves `name` to run_gate
};

/// A gate of a compiled joint instead of a phantom.
struct NamedJointGate {
  std::string_view name;
  Gate (*measure)(const std::shared_ptr<const CompiledJoint>&);  ///< as NamedGate::measure
};

/// Gates that make one report.
struct GateSet {
  std::string_view name;   ///< of the command and the report's files
  std::string_view title;  ///< as in EvidenceReport
  std::string_view source;
  std::span<const NamedGate> gates;  ///< in the order of the report
  std::span<const NamedJointGate> joint_gates = {};
};

/// All that it has, those of a joint last.
[[nodiscard]] std::vector<std::string_view> gate_names(const GateSet& set);

/// Measures one gate. Errors: not_found, with the names that there are; malformed (a gate of a
/// joint, and `joint` is null).
[[nodiscard]] Result<Gate> run_gate(const GateSet& set, std::string_view name,
                                    const std::shared_ptr<const CompiledJoint>& joint = nullptr);

/// All claims as one report, each with its gate's name.
[[nodiscard]] EvidenceReport report_of(const GateSet& set, std::span<const Gate> measured);

}  // namespace artus
