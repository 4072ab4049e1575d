// SPDX-License-Identifier: AGPL-3.0-or-later
#include "sim/experiment.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "core/text_file.h"
#include "haptics/device.h"
#include "sim/experiment_list.h"
#include "sim/probe_experiment.h"

namespace artus {
namespace {

using Run = Experiment (*)(const ExperimentOptions&, const DeviceLimits&);

constexpr std::array<std::string_view, 12> kNames{
    "wall-vs-classic", "wall-release", "wall-move",           "wall-stop",
    "wall-both",       "wall-nine",    "wall-seven",          "clamp-redirect",
    "wall-energy",     "rates",        "velocity-estimators", "layer-changes"};
constexpr std::array<Run, kNames.size()> kRuns{
    run_wall_vs_classic, run_wall_release, run_wall_move,           run_wall_stop,
    run_wall_both,       run_wall_nine,    run_wall_seven,          run_clamp_redirect,
    run_wall_energy,     run_rates,        run_velocity_estimators, run_layer_changes};

void add_cells(std::string& out, const std::vector<std::string>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) out += (i == 0 ? "" : ",") + cells[i];
  out += '\n';
}

}  // namespace

std::span<const std::string_view> needle_experiments() noexcept {
  return kNames;
}

Result<Experiment> run_needle_experiment(std::string_view name, const ExperimentOptions& options) {
  const Result<DeviceLimits> device = find_device(options.device);
  if (!device) return tl::unexpected<Error>(device.error());
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) {
      Experiment experiment = kRuns[i](options, *device);
      experiment.name = name;
      return experiment;
    }
  }
  std::string all;
  for (const std::string_view known : all_experiments()) {
    all += (all.empty() ? "" : ", ") + std::string(known);
  }
  return fail(ErrorCode::not_found,
              "no experiment \"" + std::string(name) + "\"; there are " + all);
}

Result<void> write_experiment(const Experiment& e, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), folder.string());
  for (const ExperimentTrace& trace : e.traces) {
    const std::string file = e.name + (trace.label.empty() ? "" : "-" + trace.label) + ".csv";
    auto written = write_needle_csv(folder / file, trace.rows, trace.region_names);
    if (!written) return written;
  }
  if (!e.table.header.empty()) {
    std::string text;
    add_cells(text, e.table.header);
    for (const auto& row : e.table.rows) add_cells(text, row);
    auto written = write_text(folder / (e.name + "-table.csv"), text);
    if (!written) return written;
  }
  nlohmann::json json = verdict(e.claims);
  json["experiment"] = e.name;
  json["title"] = e.title;
  auto written = write_text(folder / "verdict.json", json.dump(2) + "\n");
  if (!written) return written;
  return write_plot(folder / (e.name + ".png"), e.plot);
}

std::vector<std::string_view> all_experiments() {
  std::vector<std::string_view> names(kNames.begin(), kNames.end());
  const auto probe = probe_experiments();
  names.insert(names.end(), probe.begin(), probe.end());
  return names;
}

Result<std::vector<Claim>> run_experiment(std::string_view name,
                                          const std::filesystem::path& folder,
                                          const ExperimentOptions& options) {
  const auto probe = probe_experiments();
  if (std::find(probe.begin(), probe.end(), name) != probe.end()) {
    const auto mock = options.mock.empty() ? read_bundled_pneumatic_params()
                                           : read_pneumatic_params(options.mock);
    if (!mock) return tl::unexpected<Error>(mock.error());
    ProbeExperimentOptions probe_options;
    probe_options.seed = options.seed;
    probe_options.mock = *mock;
    return run_and_write_probe_experiment(name, folder, probe_options);
  }
  const Result<Experiment> experiment = run_needle_experiment(name, options);
  if (!experiment) return tl::unexpected<Error>(experiment.error());
  const Result<void> written = write_experiment(*experiment, folder);
  if (!written) return tl::unexpected<Error>(written.error());
  return experiment->claims;
}

}  // namespace artus
