// SPDX-License-Identifier: AGPL-3.0-or-later
// What a hand can tell of a change of layers.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/needle/experiments.h"

namespace artus {
namespace {

// Table 4.2 of the source; K_t of the bundled tissue library.
struct TableLayer {
  const char* name;
  double force;      // N
  double stiffness;  // N/m
};
constexpr std::array<TableLayer, 6> kTable{{{"skin", 1, 1500},
                                            {"muscle", 2, 500},
                                            {"bursa", 1.5, 500},
                                            {"tendon", 2.5, 500},
                                            {"cartilage", 3, 500},
                                            {"bone", 4, 4000}}};

struct Change {
  double before = 0;    // N, mean of the last millimetre before the change
  double after = 0;     // N, mean of what follows the rise
  double distance = 0;  // m, until nine tenths of the step are felt, from the interface as it lies
                        // when the tip meets it: pushed on by the tip where tissue gives way
};

// A needle pushed at 10 mm/s through 12 mm of one layer into another, as the hand feels it.
Change measure_change(const TableLayer& from, const TableLayer& to,
                      const ExperimentOptions& options, const DeviceLimits& device) {
  constexpr double kInterface = 0.012;  // m
  constexpr double kBeyond = 0.009;     // m of the second layer; of a hard one as far as it lets
  const bool hard = std::string_view(to.name) == "bone";
  const double given = options.tissue.points > 0  // m that the tissue before the tip gives way
                           ? from.force * max_tissue_compliance(from.stiffness)
                           : 0;
  BodyExperiment e;
  e.body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, kInterface});
  e.layers = {plain_layer(from.force, from.stiffness),
              hard ? bone_layer(to.force, to.stiffness) : plain_layer(to.force, to.stiffness)};
  e.names = {from.name, to.name};
  e.feel = options.feel;
  e.tissue = options.tissue;
  e.device = device;
  e.hand.tremor_rms = 0;
  e.phases = {
      stay(0.1),
      push_to(hard ? kInterface + to.force / to.stiffness + given : kInterface + kBeyond, 0.01)};
  const std::vector<NeedleRow> rows = run_body(e);
  Change change;
  double count = 0;
  for (const NeedleRow& r : rows) {
    if (r.depth < kInterface - 1e-3 || r.depth >= kInterface) continue;
    change.before += resistance(r);
    ++count;
  }
  change.before /= std::max(count, 1.0);
  count = 0;
  for (const NeedleRow& r : rows) {
    if (r.depth < e.phases.back().depth - (hard ? 2e-5 : 1e-3)) continue;
    change.after += resistance(r);
    ++count;
  }
  change.after /= std::max(count, 1.0);
  const double step = change.after - change.before;
  const auto met = std::find_if(rows.begin(), rows.end(), [](const NeedleRow& r) {
    return r.depth - r.pushed >= kInterface;
  });
  const auto felt = std::find_if(met, rows.end(), [&](const NeedleRow& r) {
    return r.depth - r.pushed >= kInterface && (resistance(r) - change.before) / step >= 0.9;
  });
  if (felt != rows.end()) change.distance = felt->depth - (kInterface + met->pushed);
  return change;
}

// One layer from its surface on, as a hand that moves by 10 mm/s feels it.
struct Rise {
  double plateau = 0;  // N
  double slope = 0;    // N/m of the hand's way, from a fifth to four fifths of the plateau
};

Rise measure_rise(const TableLayer& layer, const ExperimentOptions& options,
                  const DeviceLimits& device) {
  BodyExperiment e;
  e.layers = {plain_layer(layer.force, layer.stiffness)};
  e.names = {layer.name};
  e.feel = options.feel;
  e.tissue = options.tissue;
  e.device = device;
  e.hand.tremor_rms = 0;
  e.start_outside = 1e-3;
  e.phases = {stay(0.1), push_to(3 * layer.force / layer.stiffness, 10e-3)};
  const std::vector<NeedleRow> rows = run_body(e);
  Rise rise;
  for (const NeedleRow& r : rows) rise.plateau = std::max(rise.plateau, resistance(r));
  const auto reached = [&](double share) {
    return std::find_if(rows.begin(), rows.end(),
                        [&](const NeedleRow& r) { return resistance(r) >= share * rise.plateau; });
  };
  const auto low = reached(0.2);
  const auto high = reached(0.8);
  rise.slope = (resistance(*high) - resistance(*low)) /
               (high->needle.X_JN.translation() - low->needle.X_JN.translation()).z();
  return rise;
}

// Plateau and slope of each soft layer, at the hand.
void claim_rises(const ExperimentOptions& options, const DeviceLimits& device,
                 std::vector<Claim>& claims) {
  for (const TableLayer& layer : kTable) {
    const std::string name = layer.name;
    if (name == "bone") continue;
    const Rise rise = measure_rise(layer, options, device);
    claims.push_back(claim_near({ClaimKind::input, "the table's f_R"},
                                name + ": plateau at the hand", rise.plateau, layer.force, 0.02,
                                "N"));
    claims.push_back(claim_near({ClaimKind::input, "K_t, the tissue's share in it"},
                                name + ": slope at the hand", rise.slope, layer.stiffness, 0.02,
                                "N/m"));
  }
}

constexpr double kJnd = 0.07;      // share of the force, [Pang1991] for 2.5 to 10 N
constexpr double kWeakJnd = 0.14;  // assumed: twice that, for forces below 2.5 N

// All pairs: what the claims, the plot and the published values look at.
struct Changes {
  TextTable table{{"from", "to", "before_n", "after_n", "step_n", "step_share", "rise_mm",
                   "jnd_multiples_at_7_percent", "jnd_multiples_at_14_percent"},
                  {}};
  std::vector<PlotSeries> by_layer;
  std::array<double, kTable.size()> felt{};  // N on the plateau behind the change, of the last
  double least = std::numeric_limits<double>::infinity();  // multiples of 14 %
  double off = 0;      // share of the table's step that the measured one is off
  double longest = 0;  // mm

  void add(const TableLayer& from, std::size_t k, const Change& c) {
    const TableLayer& to = kTable[k];
    const double step = c.after - c.before;
    const double share = std::abs(step) / c.before;
    table.rows.push_back({from.name, to.name, to_csv(c.before), to_csv(c.after), to_csv(step),
                          to_csv(share), to_csv(c.distance / kMillimetre), to_csv(share / kJnd),
                          to_csv(share / kWeakJnd)});
    by_layer[k].x.push_back(c.distance / kMillimetre);
    by_layer[k].y.push_back(share / kWeakJnd);
    felt[k] = c.after;
    least = std::min(least, share / kWeakJnd);
    longest = std::max(longest, c.distance / kMillimetre);
    off = std::max(off, std::abs(step / (to.force - from.force) - 1));
  }
};

Changes measure_changes(const ExperimentOptions& options, const DeviceLimits& device) {
  Changes all;
  for (std::size_t k = 0; k < kTable.size(); ++k)
    all.by_layer.push_back({"to " + std::string(kTable[k].name), {}, {}, PlotStyle::points});
  for (const TableLayer& from : kTable) {
    if (std::string_view(from.name) == "bone") continue;  // nothing lies beyond it
    for (std::size_t k = 0; k < kTable.size(); ++k) {
      if (from.force != kTable[k].force)
        all.add(from, k, measure_change(from, kTable[k], options, device));
    }
  }
  return all;
}

}  // namespace

Experiment run_layer_changes(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out;
  out.title = "Layer changes of table 4.2, felt at 10 mm/s, in just-noticeable differences";
  out.source = "[Alamilla2020] table 4.2; [Pang1991] for the just-noticeable difference";
  Changes all = measure_changes(options, device);
  out.claims = {
      claim_at_most({ClaimKind::input, "the table's f_R"},
                    "measured step off the table's, share of the step", all.off, 0.05, ""),
      claim_at_least({ClaimKind::input, "the table's f_R"},
                     "the smallest step in just-noticeable differences of 14 %", all.least, 1, ""),
      claim_at_most({ClaimKind::input, "f_R / K_t of the layers"},
                    "the longest way until nine tenths of the step are felt", all.longest, 4.5,
                    "mm")};
  claim_rises(options, device, out.claims);
  for (std::size_t k = 0; k < kTable.size(); ++k)
    out.published.push_back(
        {kTable[k].name, to_csv(kTable[k].force) + " N", to_csv(all.felt[k]) + " N"});
  out.assumed =
      assumed_with_hand({"K_t of the tissue library, 500 N/m; 1500 in skin, 4000 on bone",
                         "a just-noticeable difference of 14 % below 2.5 N",
                         "speed, 10 mm/s; layers of 12 mm", "bounds: 5 % of the step, 4.5 mm"});
  out.tables = {{"", std::move(all.table)}};
  all.by_layer.push_back({"noticed, 7 %", {0, all.longest}, {kJnd / kWeakJnd, kJnd / kWeakJnd}});
  all.by_layer.push_back({"noticed, 14 %", {0, all.longest}, {1, 1}});
  out.plots = {{"",
                {out.title,
                 {{"distance until 90 % of the step (mm)", "force step (multiples of 14 %)",
                   std::move(all.by_layer), true}}}}};
  return out;
}

}  // namespace artus
