// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/evidence/report.h"

namespace artus {

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

/// Gates that make one report.
struct GateSet {
  std::string_view name;   ///< of the command and the report's files
  std::string_view title;  ///< as in EvidenceReport
  std::string_view source;
  std::span<const NamedGate> gates;  ///< in the order of the report
};

/// Measures one gate. Errors: not_found, with the names that there are.
[[nodiscard]] Result<Gate> run_gate(const GateSet& set, std::string_view name);

/// All claims as one report, each with its gate's name.
[[nodiscard]] EvidenceReport report_of(const GateSet& set, std::span<const Gate> measured);

}  // namespace artus
