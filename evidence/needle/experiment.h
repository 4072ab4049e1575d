// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/csv.h"
#include "artus/evidence/claim.h"
#include "artus/evidence/needle/needle_trace.h"
#include "artus/evidence/plot.h"
#include "artus/haptics/needle/needle_feel.h"

namespace artus {

struct ExperimentOptions {
  std::uint64_t seed = 1;
  std::string device = "virtuose_6d_desktop";  ///< a name of device_table()
  NeedleFeel feel;                             ///< what is not set is as published
  std::filesystem::path mock;  ///< TOML file of the pneumatic probe mock; empty: the bundled one
};

/// A trace of an experiment that has one or several.
struct ExperimentTrace {
  std::string label;  ///< part of the file name; may be empty when there is one
  std::vector<NeedleRow> rows;
  std::vector<std::string> region_names;
};

/// What the source says of its experiment, beside what this one shows.
struct PublishedValue {
  std::string what;
  std::string published;  ///< in the source's words and figures
  std::string artus;      ///< value and unit
};

/// What an experiment gave.
struct Experiment {
  std::string name;
  std::string title;   ///< what it shows
  std::string source;  ///< figures, tables and equations of the source it stands beside
  std::vector<PublishedValue> published;
  std::vector<ExperimentTrace> traces;
  TextTable table;  ///< empty header: none
  Plot plot;
  std::vector<Claim> claims;
};

/// The names of all needle experiments, in the order of the report.
[[nodiscard]] std::span<const std::string_view> needle_experiments() noexcept;

/// Runs a needle experiment, deterministic for its options. Errors: not_found (no such experiment
/// or device).
[[nodiscard]] Result<Experiment> run_needle_experiment(std::string_view name,
                                                       const ExperimentOptions& options = {});

/// Writes <name>[-label].csv, <name>-table.csv, <name>.png and verdict.json into `folder`. Errors:
/// unreadable, not_found (gnuplot; all other files are then written all the same).
[[nodiscard]] Result<void> write_experiment(const Experiment& experiment,
                                            const std::filesystem::path& folder);

}  // namespace artus
