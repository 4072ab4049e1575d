// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/evidence/gate.h"
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

/// An experiment as a gate, its traces as files beside it; on options.mock. The first table is that
/// of the observations. Errors: those of read_pneumatic_params.
[[nodiscard]] Result<Gate> measure_probe_experiment(
    std::string_view name, ProbeExperiment (*run)(const ProbeExperimentOptions&),
    const GateOptions& options);

}  // namespace artus
