// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/probe/probe_experiment.h"

#include <array>

#include "artus/core/text_file.h"
#include "artus/evidence/probe/probe_experiment_list.h"

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
  std::string all;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return kRuns[i](options);
    all += (all.empty() ? "" : ", ") + std::string(kNames[i]);
  }
  return fail(ErrorCode::not_found,
              "no probe experiment \"" + std::string(name) + "\"; there are " + all);
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
