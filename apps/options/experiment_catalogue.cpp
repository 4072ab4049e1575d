// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/experiment_catalogue.h"

#include <algorithm>

#include "artus/detail/core/csv.h"
#include "artus/detail/evidence/validation/probe/probe_experiment.h"

namespace artus {

namespace {

std::string said(const Claim& claim) {
  return std::string(claim.pass ? "holds" : "FAILS") + ", " + to_csv(claim.value);
}

/// Claims of the same text, one a row; one that only one of the two makes stands alone.
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

}  // namespace

std::vector<std::string_view> all_experiments() {
  const auto needle = needle_experiments();
  std::vector<std::string_view> names(needle.begin(), needle.end());
  const auto probe = probe_experiments();
  names.insert(names.end(), probe.begin(), probe.end());
  return names;
}

Result<EvidenceReport> run_experiment(std::string_view name, const std::filesystem::path& folder,
                                      const ExperimentOptions& options) {
  const auto probe = probe_experiments();
  if (std::find(probe.begin(), probe.end(), name) == probe.end()) {
    ExperimentOptions rigid = options;
    rigid.tissue = {};
    Result<Experiment> experiment = run_needle_experiment(name, rigid);
    ARTUS_TRY(experiment);
    if (options.tissue.points > 0) {
      const Result<Experiment> tissue = run_needle_experiment(name, options);
      ARTUS_TRY(tissue);
      ARTUS_TRY(write_experiment(*tissue, folder / "tissue"));
      experiment->tables.emplace_back(kBesideTable, beside(experiment->claims, tissue->claims));
    }
    ARTUS_TRY(write_experiment(*experiment, folder));
    return static_cast<const EvidenceReport&>(*experiment);
  }
  ARTUS_TRY(check(options.feel, {std::string(name), {}, 0, "is of the other hand, the probe's"}));
  const auto mock =
      options.mock.empty() ? read_bundled_pneumatic_params() : read_pneumatic_params(options.mock);
  ARTUS_TRY(mock);
  ProbeExperimentOptions probe_options;
  probe_options.seed = options.seed;
  probe_options.mock = *mock;
  const Result<ProbeExperiment> experiment = run_probe_experiment(name, probe_options);
  ARTUS_TRY(experiment);
  ARTUS_TRY(write_probe_experiment(*experiment, folder));
  return static_cast<const EvidenceReport&>(*experiment);
}

}  // namespace artus
