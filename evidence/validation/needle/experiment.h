// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "artus/detail/evidence/gate.h"
#include "artus/detail/evidence/runs/needle_trace.h"
#include "artus/detail/haptics/needle/needle_packet.h"
#include "artus/haptics/device.h"
#include "artus/haptics/needle_feel.h"

namespace artus {

struct ExperimentOptions {
  std::uint64_t seed = 1;
  NeedleFeel feel;                    ///< what is not set is as published
  NeedleCompliance tissue;            ///< around the needle's track; no points: rigid, as published
  std::vector<DeviceLimits> devices;  ///< that `rates` compares; none: all of device_table()
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

/// The laws that a run of an experiment may change.
struct ExperimentLaws {
  std::uint32_t takes = 0;   ///< FeelKind bits
  std::string_view why_not;  ///< why not the others: "has a tissue that only cuts"
  std::size_t layers = 0;    ///< numbered ones; 0: those of table 4.2
};

using RunExperiment = Experiment (*)(const ExperimentOptions&, const DeviceLimits&);

/// Title of the table of an experiment's claims rigid and in tissue.
inline constexpr std::string_view kBesideTable =
    "The claims rigid, as published, and with tissue that gives way";

/// An experiment as a gate: rigid, as published, its traces as files beside it; with
/// options.tissue, also in tissue that gives way, which is told in kBesideTable and lies in the
/// folder tissue/. Errors: not_found (the device); those of check(NeedleFeel).
[[nodiscard]] Result<Gate> measure_experiment(std::string_view name, RunExperiment run,
                                              const ExperimentLaws& laws,
                                              const GateOptions& options);

}  // namespace artus
