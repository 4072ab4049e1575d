// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/evidence/report.h"

namespace artus {

/// One gate of the syringe and the places: what was measured, against what.
struct InjectionGate {
  std::string name;
  std::string title;  ///< what is measured, and where the bound comes from
  std::vector<Claim> claims;
};

/// The names of all gates, in the order of the report.
[[nodiscard]] std::span<const std::string_view> injection_gates() noexcept;

/// Measures one gate; deterministic. Errors: not_found. Cost: below 2 s.
[[nodiscard]] Result<InjectionGate> run_injection_gate(std::string_view name);

/// All claims as one report.
[[nodiscard]] EvidenceReport report_of(std::span<const InjectionGate> gates);

}  // namespace artus
