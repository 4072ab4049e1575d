// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/apps/experiment_catalogue.h"

#include <algorithm>

#include "artus/evidence/probe/probe_experiment.h"

namespace artus {

std::vector<std::string_view> all_experiments() {
  const auto needle = needle_experiments();
  std::vector<std::string_view> names(needle.begin(), needle.end());
  const auto probe = probe_experiments();
  names.insert(names.end(), probe.begin(), probe.end());
  return names;
}

Result<std::vector<Claim>> run_experiment(std::string_view name,
                                          const std::filesystem::path& folder,
                                          const ExperimentOptions& options) {
  const auto probe = probe_experiments();
  if (std::find(probe.begin(), probe.end(), name) != probe.end()) {
    ARTUS_TRY(check(options.feel, {std::string(name), {}, 0, "is of the other hand, the probe's"}));
    const auto mock = options.mock.empty() ? read_bundled_pneumatic_params()
                                           : read_pneumatic_params(options.mock);
    ARTUS_TRY(mock);
    ProbeExperimentOptions probe_options;
    probe_options.seed = options.seed;
    probe_options.mock = *mock;
    return run_and_write_probe_experiment(name, folder, probe_options);
  }
  const Result<Experiment> experiment = run_needle_experiment(name, options);
  ARTUS_TRY(experiment);
  const Result<void> written = write_experiment(*experiment, folder);
  ARTUS_TRY(written);
  return experiment->claims;
}

}  // namespace artus
