// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "artus/core/csv.h"
#include "artus/core/result.h"
#include "artus/evidence/claim.h"
#include "artus/evidence/plot.h"
#include "artus/evidence/probe/probe_experiment_bench.h"

namespace artus {

struct ProbeExperimentOptions {
  std::uint64_t seed = 1;
  PneumaticParams mock;     ///< the hardware that is simulated
  bool assumptions = true;  ///< also run with other values where the source prints none
};

/// One run of one law.
struct ProbeTrace {
  std::string label;
  std::vector<ProbeRow> rows;
};

/// One published observation beside what artus measures.
struct ProbeObservation {
  std::string what;
  std::string published;  ///< as the source states it
  double artus = 0;       ///< measured
  std::string unit;
  std::string difference;  ///< in words and figures
  bool reproduced = false;
  std::string cause;  ///< of a difference; empty when there is none
  /// What a parameter of the mock was fitted to this figure; empty: the comparison is independent.
  std::string fitted;
};

/// A plot and the file it goes to.
struct NamedPlot {
  std::string file;  ///< without folder
  Plot plot;
};

/// What a probe experiment gave.
struct ProbeExperiment {
  std::string name;
  std::string title;
  std::vector<ProbeTrace> traces;
  std::vector<NamedPlot> plots;
  std::vector<ProbeObservation> observations;  ///< published against artus; none in the study
  std::vector<std::pair<std::string, TextTable>> tables;  ///< with what each shows
  std::vector<Claim> claims;                              ///< what must hold whatever was published
};

/// probe-isp, probe-ssp, probe-study.
[[nodiscard]] std::span<const std::string_view> probe_experiments() noexcept;

/// Runs one; deterministic for its options. Errors: not_found.
[[nodiscard]] Result<ProbeExperiment> run_probe_experiment(
    std::string_view name, const ProbeExperimentOptions& options = {});

/// Writes <name>-<label>.csv, the plots, <name>-table.csv (observations, or what the study's first
/// table shows), report.md and verdict.json into `folder` (made when missing). Errors: unreadable,
/// not_found (gnuplot; all other files are then written all the same).
[[nodiscard]] Result<void> write_probe_experiment(const ProbeExperiment& experiment,
                                                  const std::filesystem::path& folder);

/// Both, and the claims of what must hold.
[[nodiscard]] Result<std::vector<Claim>> run_and_write_probe_experiment(
    std::string_view name, const std::filesystem::path& folder,
    const ProbeExperimentOptions& options = {});

}  // namespace artus
