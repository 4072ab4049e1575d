// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/needle/experiment.h"

#include <algorithm>
#include <array>

#include "artus/detail/core/known_names.h"
#include "artus/detail/evidence/validation/needle/experiment_list.h"
#include "artus/haptics/device.h"

namespace artus {
namespace {

// An experiment, the laws that a run of it may change, and why not the others.
struct Entry {
  std::string_view name;
  Experiment (*run)(const ExperimentOptions&, const DeviceLimits&);
  std::uint32_t takes;
  std::string_view why_not;
  std::size_t layers;  // numbered ones; 0: those of table 4.2
};

constexpr std::uint32_t kWall =
    FeelKind::kCutting | FeelKind::kPatient | FeelKind::kWorkspace | FeelKind::kPassivity;
constexpr std::array<Entry, 12> kEntries{{
    {"wall-vs-classic", run_wall_vs_classic, FeelKind::kPassivity,
     "compares four fixed cutting laws in a tissue that only cuts", 1},
    {"wall-release", run_wall_release,
     FeelKind::kFriction | FeelKind::kPatient | FeelKind::kPassivity,
     "compares the tracking wall alone, with shaft friction and no tissue", 1},
    {"wall-move", run_wall_move, kWall, "has a tissue that only cuts", 1},
    {"wall-stop", run_wall_stop, kWall, "has a tissue that only cuts", 1},
    {"wall-both", run_wall_both, kWall, "has a tissue that only cuts", 1},
    {"wall-nine", run_wall_nine, kWall | FeelKind::kClamping,
     "has tissues that only cut and hold the needle's line", 9},
    {"wall-seven", run_wall_seven, kWall | FeelKind::kClamping,
     "has tissues that only cut and hold the needle's line", 7},
    {"clamp-redirect", run_clamp_redirect, kWall | FeelKind::kClamping | FeelKind::kFriction,
     "has neither a membrane nor bone", 1},
    {"wall-energy", run_wall_energy,
     FeelKind::kCutting | FeelKind::kPrepuncture | FeelKind::kTap | FeelKind::kFriction |
         FeelKind::kPatient,
     "moves the needle along one line and lets no controller help", 6},
    {"rates", run_rates, FeelKind::kAll, "", 0},
    {"velocity-estimators", run_velocity_estimators, 0, "uses no force law", 0},
    {"layer-changes", run_layer_changes, kWall, "has tissues that only cut", 0},
}};

constexpr std::array<std::string_view, kEntries.size()> kNames = [] {
  std::array<std::string_view, kEntries.size()> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kEntries[i].name;
  return names;
}();

}  // namespace

std::vector<std::string> assumed_with_hand(std::vector<std::string> own) {
  own.insert(own.end(),
             {"the hand's stiffness (1500 N/m), damping (30 N s/m), mass, tremor (20 um rms, 8 to "
              "12 Hz), lag (30 ms) and opening of its fingers (50 ms): orders of size of what is "
              "published",
              "moving mass, damping and encoder step of the simulated devices"});
  return own;
}

std::span<const std::string_view> needle_experiments() noexcept {
  return kNames;
}

Result<Experiment> run_needle_experiment(std::string_view name, const ExperimentOptions& options) {
  const Result<DeviceLimits> device = find_device(options.device);
  ARTUS_TRY(device);
  const auto at = find_name(kNames, name, "needle experiment");
  ARTUS_TRY(at);
  const Entry& entry = kEntries.at(*at);
  const auto layers = entry.layers > 0 ? numbered_layers(entry.layers) : table_layer_names();
  ARTUS_TRY(
      check(options.feel, {std::string(name), layers, entry.takes, std::string(entry.why_not)}));
  Experiment experiment = entry.run(options, *device);
  experiment.name = name;
  for (NamedPlot& plot : experiment.plots)
    if (plot.file.empty()) plot.file = experiment.name + ".svg";
  return experiment;
}

Result<void> write_experiment(const Experiment& e, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), folder.string());
  for (const ExperimentTrace& trace : e.traces) {
    const std::string file = e.name + (trace.label.empty() ? "" : "-" + trace.label) + ".csv";
    ARTUS_TRY(write_needle_csv(folder / file, trace.rows, trace.region_names));
  }
  return write_report(e, folder);
}

}  // namespace artus
