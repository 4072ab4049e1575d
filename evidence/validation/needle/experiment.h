// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/detail/evidence/report.h"
#include "artus/detail/evidence/runs/needle_trace.h"
#include "artus/detail/haptics/needle/needle_packet.h"
#include "artus/haptics/needle_feel.h"

namespace artus {

struct ExperimentOptions {
  std::uint64_t seed = 1;
  std::string device = "virtuose_6d_desktop";  ///< a name of device_table()
  NeedleFeel feel;                             ///< what is not set is as published
  NeedleCompliance tissue;     ///< around the needle's track; no points: rigid, as published
  std::filesystem::path mock;  ///< TOML file of the pneumatic probe mock; empty: the bundled one
};

/// A trace of an experiment that has one or several.
struct ExperimentTrace {
  std::string label;  ///< part of the file name; may be empty when there is one
  std::vector<NeedleRow> rows;
  std::vector<std::string> region_names;
};

/// What an experiment gave.
struct Experiment : EvidenceReport {
  std::vector<ExperimentTrace> traces;
};

/// The names of all needle experiments, in the order of the report.
[[nodiscard]] std::span<const std::string_view> needle_experiments() noexcept;

/// Runs a needle experiment, deterministic for its options. Errors: not_found (no such experiment
/// or device).
[[nodiscard]] Result<Experiment> run_needle_experiment(std::string_view name,
                                                       const ExperimentOptions& options = {});

/// Writes <name>[-label].csv and what write_report() does, with its errors, into `folder`.
[[nodiscard]] Result<void> write_experiment(const Experiment& experiment,
                                            const std::filesystem::path& folder);

}  // namespace artus
