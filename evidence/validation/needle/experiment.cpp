// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/needle/experiment.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "artus/detail/core/csv.h"
#include "artus/detail/evidence/validation/needle/experiments.h"
#include "artus/detail/evidence/validation/soft/needled_block.h"
#include "artus/haptics/device.h"

namespace artus {
namespace {

constexpr double kRadius21 = 0.409e-3;  // m, of a 21 G needle

std::string said(const Claim& claim) {
  return std::string(claim.pass ? "holds" : "FAILS") + ", " + to_csv(claim.value);
}

/// Claims of the same text, one a row; one that the tissue's run does not make stands alone.
TextTable beside(const std::vector<Claim>& rigid, const std::vector<Claim>& tissue) {
  TextTable table{{"claim", "bound", "rigid", "with tissue"}, {}};
  for (const Claim& claim : rigid) {
    const auto other = std::find_if(tissue.begin(), tissue.end(),
                                    [&](const Claim& c) { return c.text == claim.text; });
    table.rows.push_back(
        {claim.text, claim.bound, said(claim), other != tissue.end() ? said(*other) : "not made"});
  }
  return table;
}

/// The experiment with its name, and its traces as files.
Gate to_gate(std::string_view name, Experiment experiment) {
  experiment.name = name;
  for (NamedPlot& plot : experiment.plots)
    if (plot.file.empty()) plot.file = experiment.name + ".svg";
  for (ExperimentTrace& trace : experiment.traces) {
    const std::string file =
        experiment.name + (trace.label.empty() ? "" : "-" + trace.label) + ".csv";
    const auto kept = std::make_shared<const ExperimentTrace>(std::move(trace));
    experiment.files.push_back({file, [kept](const std::filesystem::path& path) {
                                  return write_needle_csv(path, kept->rows, kept->region_names);
                                }});
  }
  Gate gate = std::move(experiment);
  return gate;
}

}  // namespace

std::vector<std::string> assumed_with_hand(std::vector<std::string> own) {
  own.insert(own.end(),
             {"the hand's stiffness (1500 N/m), damping (30 N s/m), mass, tremor (20 um rms, 8 to "
              "12 Hz), lag (30 ms) and opening of its fingers (50 ms): orders of size of what is "
              "published",
              "moving mass, damping and encoder step of the simulated devices"});
  return own;
}

Result<Gate> measure_experiment(std::string_view name, RunExperiment run,
                                const ExperimentLaws& laws, const GateOptions& options) {
  const Result<DeviceLimits> device = find_device(options.device);
  ARTUS_TRY(device);
  const auto layers = laws.layers > 0 ? numbered_layers(laws.layers) : table_layer_names();
  ARTUS_TRY(
      check(options.feel, {std::string(name), layers, laws.takes, std::string(laws.why_not)}));
  ExperimentOptions how{options.seed, options.feel, {}, {}};
  Gate gate = to_gate(name, run(how, *device));
  if (!options.tissue) return gate;
  how.tissue = NeedledBlock().compliance(kRadius21);
  const auto tissue = std::make_shared<const Gate>(to_gate(name, run(how, *device)));
  gate.tables.emplace_back(kBesideTable, beside(gate.claims, tissue->claims));
  gate.files.push_back({"tissue", [tissue](const std::filesystem::path& folder) {
                          return write_report(*tissue, folder);
                        }});
  return gate;
}

}  // namespace artus
