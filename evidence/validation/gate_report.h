// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "artus/core/result.h"
#include "artus/detail/evidence/validation/gates.h"
#include "artus/detail/evidence/validation/provenance.h"

namespace artus {

/// A set of which some gates, or all, were measured.
struct MeasuredSet {
  const GateSet* set = nullptr;
  std::vector<Gate> gates;
};

/// All claims of all sets, each with its gate's name in front.
[[nodiscard]] std::vector<Claim> all_claims(std::span<const MeasuredSet> sets);

/// {"set", "title", "source", "pass", "counts", "claims": [...], "gates": {name: verdict}}; a
/// needle experiment that also ran in tissue has "with_tissue": {claim: "holds, value"}.
[[nodiscard]] nlohmann::json verdict(const MeasuredSet& measured);
/// That of the only set, or {"pass", "counts", "sets": {name: verdict}}.
[[nodiscard]] nlohmann::json verdict(std::span<const MeasuredSet> sets);

/// Writes report.md, the set's verdict file and <set>-table.csv, with the gates' plots and files,
/// into `folder`. Gates of a set that keeps them apart have a folder each, but for an only one.
/// Errors: as write_report.
[[nodiscard]] Result<void> write_report(const MeasuredSet& measured,
                                        const std::filesystem::path& folder);

/// The page of docs/results: where it comes from, then every claim with kind, measured value, bound
/// and whether it holds.
[[nodiscard]] std::string results_page(const MeasuredSet& measured, const Provenance& from);

}  // namespace artus
