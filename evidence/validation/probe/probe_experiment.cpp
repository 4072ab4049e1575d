// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/probe/probe_experiment.h"

#include <array>

#include "artus/detail/core/known_names.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/evidence/validation/probe/probe_experiment_list.h"

namespace artus {
namespace {

using Run = ProbeExperiment (*)(const ProbeExperimentOptions&);

constexpr std::array<std::string_view, 3> kNames{"probe-isp", "probe-ssp", "probe-study"};
constexpr std::array<Run, kNames.size()> kRuns{run_probe_isp, run_probe_ssp, run_probe_study};

}  // namespace

std::span<const std::string_view> probe_experiments() noexcept {
  return kNames;
}

Result<ProbeExperiment> run_probe_experiment(std::string_view name,
                                             const ProbeExperimentOptions& options) {
  const auto at = find_name(kNames, name, "probe experiment");
  ARTUS_TRY(at);
  return kRuns.at(*at)(options);
}

Result<void> write_probe_experiment(const ProbeExperiment& e, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), folder.string());
  for (const ProbeTrace& trace : e.traces)
    ARTUS_TRY(write_text(folder / (e.name + "-" + trace.label + ".csv"), probe_csv(trace.rows)));
  return write_report(e, folder);
}

}  // namespace artus
