// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/probe/probe_experiment.h"

#include <memory>
#include <utility>

#include "artus/detail/core/text_file.h"

namespace artus {

Result<Gate> measure_probe_experiment(std::string_view name,
                                      ProbeExperiment (*run)(const ProbeExperimentOptions&),
                                      const GateOptions& options) {
  const auto mock =
      options.mock.empty() ? read_bundled_pneumatic_params() : read_pneumatic_params(options.mock);
  ARTUS_TRY(mock);
  ProbeExperiment experiment = run({options.seed, *mock});
  for (ProbeTrace& trace : experiment.traces) {
    const std::string file = std::string(name) + "-" + trace.label + ".csv";
    const auto kept = std::make_shared<const ProbeTrace>(std::move(trace));
    experiment.files.push_back({file, [kept](const std::filesystem::path& path) {
                                  return write_text(path, probe_csv(kept->rows));
                                }});
  }
  Gate gate = std::move(experiment);
  return gate;
}

}  // namespace artus
