// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/evidence/report.h"
#include "artus/detail/evidence/validation/probe/probe_experiment_bench.h"

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
  ClaimBasis basis{ClaimKind::independent};
  /// Of a refuted one: the other values with which a rerun reproduces it, or that none does.
  std::string cause;
};

/// What a probe experiment gave. Each observation is one of the claims, too.
struct ProbeExperiment : EvidenceReport {
  std::vector<ProbeTrace> traces;
  std::vector<ProbeObservation> observations;  ///< published against artus; none in the study
};

/// probe-isp, probe-ssp, probe-study.
[[nodiscard]] std::span<const std::string_view> probe_experiments() noexcept;

/// Runs one; deterministic for its options. Errors: not_found.
[[nodiscard]] Result<ProbeExperiment> run_probe_experiment(
    std::string_view name, const ProbeExperimentOptions& options = {});

/// Writes <name>-<label>.csv and what write_report() does, with its errors, into `folder`; the
/// first table is that of the observations.
[[nodiscard]] Result<void> write_probe_experiment(const ProbeExperiment& experiment,
                                                  const std::filesystem::path& folder);

}  // namespace artus
