// SPDX-License-Identifier: AGPL-3.0-or-later
// A needle that is let go: what the laws do to it, and what the hand's own momentum does.
#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/needle/experiments.h"
#include "artus/detail/evidence/validation/needle/release.h"

namespace artus {
namespace {

constexpr double kReleaseDepth = 25e-3;    // m of intended insertion: friction grows with the shaft
constexpr double kReleaseStiffness = 500;  // N/m, K_t
constexpr double kFree = 1.0;              // s without a hand
constexpr double kSettled = 0.5;           // s of them after which the needle should be at rest
constexpr double kAtOnce = 1e-4;           // s in which the fingers open
constexpr std::uint64_t kHands = 10;

enum class Around { none, wall, wall_and_friction };
constexpr std::array<Around, 3> kAround{Around::none, Around::wall, Around::wall_and_friction};

const char* name_of(Around tissue) {
  switch (tissue) {
    case Around::none:
      return "no tissue";
    case Around::wall:
      return "wall alone";
    case Around::wall_and_friction:
      return "wall and shaft friction";
  }
  return "";
}

// For a file's name.
std::string label_of(Around tissue) {
  std::string label = name_of(tissue);
  std::replace(label.begin(), label.end(), ' ', '-');
  return label;
}

std::vector<NeedleRow> run_one_release(Around tissue, double release_time,
                                       const DeviceLimits& device, const ExperimentOptions& options,
                                       HandParams hand) {
  constexpr double kFarAway = 0.1;  // m, a skin that the needle never reaches
  BodyExperiment e;
  e.layers = {plain_layer(1, kReleaseStiffness)};
  if (tissue == Around::wall_and_friction) e.layers[0].tissue.friction = 1;
  e.body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(),
                                    {tissue == Around::none ? kFarAway : 0.0});
  e.device = device;
  e.feel = options.feel;
  e.tissue = options.tissue;
  e.hand = hand;
  e.hand.release_time = release_time;
  e.phases = {stay(0.3), push_to(kReleaseDepth, 0.01), stay(1.5), let_go(kFree)};
  return run_body(e);
}

struct Released {
  double out = 0;     // m towards the skin
  double beyond = 0;  // m of it beyond the momentum that the hand left
  double work = 0;    // J done by the device on the needle, at most, until any later instant
  double ripple = 0;  // N peak to peak, at rest
};

Released measure_path_out(const std::vector<NeedleRow>& rows, const DeviceLimits& device) {
  const double release = rows.back().time - kFree;
  const Release let_go = measure_release(rows, release, rows.back().time, device);
  Released r;
  r.out = let_go.moved;
  r.beyond = let_go.ejection();
  double before = 0;
  double least = 0;
  double most = 0;
  bool settled = false;
  for (const NeedleRow& row : rows) {
    if (row.time < release) {
      before = row.energy_to_hand;
      continue;
    }
    r.work = std::max(r.work, row.energy_to_hand - before);
    if (row.time < release + kSettled) continue;
    const double force = row.command.force.z();
    least = settled ? std::min(least, force) : force;
    most = settled ? std::max(most, force) : force;
    settled = true;
  }
  r.ripple = most - least;
  return r;
}

// A curve from the release on.
template <class F>
PlotSeries plot_released(const std::vector<NeedleRow>& rows, const char* label, F value) {
  PlotSeries series{label, {}, {}};
  const double release = rows.back().time - kFree;
  for (const NeedleRow& row : rows) {
    if (row.time < release - 0.1 || row.time > release + kSettled) continue;
    series.x.push_back(row.time - release);
    series.y.push_back(value(row));
  }
  return series;
}

// The worst of the hands.
struct Worst {
  std::vector<double> paths;  // mm, sorted
  double beyond = 0;          // mm
  double work = 0;            // J
  double ripple = 0;          // N
  double calm = 0;            // mm, of a hand without tremor
};

void add_release_claims(const DeviceLimits& device, Around tissue, double release,
                        const Worst& worst, std::vector<Claim>& claims) {
  if (tissue == Around::none) return;
  const std::string how = std::string(device.name) + ", " + name_of(tissue) +
                          (release == kAtOnce ? ", let go at once" : ", let go over 50 ms");
  const std::string what = how + ", worst of 10 hands: ";
  claims.push_back(
      claim_at_most(ClaimKind::independent, what + "ejection", worst.paths.back(), 0.2, "mm"));
  if (tissue == Around::wall) {
    claims.push_back(claim_at_most(
        ClaimKind::independent, how + ", a hand without tremor: ejection", worst.calm, 0.2, "mm"));
    const double grain = 0.5 * kReleaseStiffness * device.encoder_step * device.encoder_step;
    claims.push_back(claim_at_most(
        {ClaimKind::fitted, "the bound was set after the plain ejection had failed"},
        what + "energy given to the needle, in that of the wall's spring over an encoder step",
        worst.work / grain, 1, ""));
  } else {
    const double step =
        2 * device.encoder_step * (kReleaseStiffness + LugreParams{}.stiffness_limit);
    claims.push_back(
        claim_at_most({ClaimKind::fitted, "the bristle's bound was chosen by the rates"},
                      what + "force at rest, peak to peak, in two encoder steps' worth",
                      worst.ripple / step, 1, ""));
  }
}

// Ten hands and one that does not tremble; the rows of the first of the ten in `shown`.
Worst run_hands(Around tissue, double release, const DeviceLimits& device,
                const ExperimentOptions& options, std::vector<NeedleRow>& shown) {
  Worst worst;
  HandParams hand;
  hand.tremor_rms = 0;
  worst.calm =
      measure_path_out(run_one_release(tissue, release, device, options, hand), device).out /
      kMillimetre;
  for (std::uint64_t i = 0; i < kHands; ++i) {
    hand = HandParams{};
    hand.seed = options.seed + i;
    std::vector<NeedleRow> rows = run_one_release(tissue, release, device, options, hand);
    const Released r = measure_path_out(rows, device);
    worst.paths.push_back(r.out / kMillimetre);
    worst.beyond = std::max(worst.beyond, r.beyond / kMillimetre);
    worst.work = std::max(worst.work, r.work);
    worst.ripple = std::max(worst.ripple, r.ripple);
    if (i == 0) shown = std::move(rows);
  }
  std::sort(worst.paths.begin(), worst.paths.end());
  return worst;
}

}  // namespace

Experiment run_wall_release(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out;
  out.title =
      "Stop, then let go at once or over 50 ms: the needle stays, with and without friction";
  out.source = "[Alamilla2020] section 2.2: the tool keeps its position when the user lets go";
  TextTable table{
      {"device", "tissue", "release_ms", "out_mm_median", "out_mm_worst",
       "beyond_momentum_mm_worst", "out_mm_no_tremor", "work_uj_worst", "ripple_n_worst"},
      {}};
  PlotPanel position{"time since the release (s), let go at once", "tip (mm)", {}};
  PlotPanel force{"time since the release (s), let go at once", "force on the hand (N)", {}};
  for (const DeviceLimits& each : device_table()) {
    for (const Around tissue : kAround) {
      for (const double release : {kAtOnce, HandParams{}.release_time}) {
        std::vector<NeedleRow> rows;
        const Worst worst = run_hands(tissue, release, each, options, rows);
        table.rows.push_back({std::string(each.name), name_of(tissue), to_csv(1e3 * release),
                              to_csv(worst.paths[worst.paths.size() / 2]),
                              to_csv(worst.paths.back()), to_csv(worst.beyond), to_csv(worst.calm),
                              to_csv(1e6 * worst.work), to_csv(worst.ripple)});
        add_release_claims(each, tissue, release, worst, out.claims);
        if (each.name != device.name || release != kAtOnce) continue;
        position.series.push_back(plot_released(rows, name_of(tissue), [](const NeedleRow& row) {
          return row.needle.X_JN.translation().z() / kMillimetre;
        }));
        force.series.push_back(plot_released(
            rows, name_of(tissue), [](const NeedleRow& row) { return row.command.force.z(); }));
        out.traces.push_back({label_of(tissue), std::move(rows), layer_names(1)});
      }
    }
  }
  out.assumed = assumed_with_hand({"depth 25 mm, speed 10 mm/s, 1.5 s of rest; 1 N, 500 N/m",
                                   "\"at once\": fingers that open within 0.1 ms",
                                   "no dry friction in the simulated devices: a needle that is "
                                   "let go coasts"});
  out.tables = {{"", std::move(table)}};
  out.plots = {{"", {out.title, {std::move(position), std::move(force)}}}};
  return out;
}

}  // namespace artus
