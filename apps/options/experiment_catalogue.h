// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include "artus/detail/evidence/validation/needle/experiment.h"

namespace artus {

inline constexpr std::string_view kBesideTable =
    "The claims rigid, as published, and with tissue that gives way";

/// The names of all experiments of both hands.
[[nodiscard]] std::vector<std::string_view> all_experiments();

/// Runs any of all_experiments() and writes it into `folder`: the whole of `artus experiment <name>
/// --out dir`. A needle experiment whose options have tissue that gives way is run rigid, as
/// published, and with the tissue; the report is the rigid one, with a table of both claims side by
/// side (kBesideTable), and the other one is in the folder tissue/.
[[nodiscard]] Result<EvidenceReport> run_experiment(std::string_view name,
                                                    const std::filesystem::path& folder,
                                                    const ExperimentOptions& options = {});

}  // namespace artus
