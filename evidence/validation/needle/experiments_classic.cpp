// SPDX-License-Identifier: AGPL-3.0-or-later
// The tracking wall beside the methods it replaces.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/needle/experiments.h"
#include "artus/detail/evidence/validation/needle/high_pass.h"
#include "artus/detail/evidence/validation/needle/release.h"

namespace artus {
namespace {

constexpr double kHighPass = 20;  // Hz
constexpr double kDepth = 6e-3;   // m of intended insertion
constexpr double kSpeed = 0.01;   // m/s
constexpr double kForce = 1;      // N, f_R
constexpr double kHeld = 1.5;     // s

struct Measured {
  double moved = 0;     // m the needle comes out after the release
  double ejection = 0;  // m of it beyond its momentum
  double guided = 0;    // N^2 s above 20 Hz, in contact until the release
  double contact = 0;   // N^2 s above 20 Hz, in contact over the whole cycle
  double limited = 0;   // share of the contact until the release at the device's limit
  double energy = 0;    // J given to the hand over insertion, release, withdrawal
};

// When the fingers began to open and when they close again: between, the hand's force is exactly
// zero once they are open.
std::pair<double, double> released(const std::vector<NeedleRow>& rows) {
  double from = 0;
  double to = 0;
  for (const NeedleRow& r : rows) {
    if (r.time == 0 || r.hand.norm() > 0) continue;
    if (from == 0) from = r.time;
    to = r.time;
  }
  return {from - HandParams{}.release_time, to};
}

Measured measure(const std::vector<NeedleRow>& rows, double rate, const DeviceLimits& device) {
  const auto [opened, regrip] = released(rows);
  const double release = opened;
  Measured m;
  HighPass filter(kHighPass, rate);
  double guided = 0;
  for (const NeedleRow& r : rows) {
    const double high = filter.step(r.command.force.dot(Vec3::UnitZ()));
    const double share = r.depth > 0 ? high * high / rate : 0;
    m.contact += share;
    if (r.time >= release || r.depth <= 0) continue;
    m.guided += share;
    ++guided;
    if ((r.status & TickStatus::kSaturated) != 0) ++m.limited;
  }
  m.limited /= std::max(guided, 1.0);
  const Release let_go = measure_release(rows, release, regrip, device);
  m.moved = let_go.moved;
  m.ejection = let_go.ejection();
  m.energy = rows.back().energy_to_hand;
  return m;
}

constexpr std::array<CuttingLaw, 4> kLaws{CuttingLaw::tracking_wall, CuttingLaw::direct,
                                          CuttingLaw::spring, CuttingLaw::voigt};
constexpr std::array<double, 3> kStiffnesses{500, 1000, 2000};  // N/m
constexpr std::uint64_t kSeeds = 10;

std::vector<NeedleRow> run_release(CuttingLaw law, double stiffness, const DeviceLimits& device,
                                   const ExperimentOptions& options, const HandParams& hand) {
  BodyExperiment e;
  e.layers = {plain_layer(kForce, stiffness)};
  e.layers[0].cutting = law;
  e.entry = Vec3(0, 0, 0.12);
  e.body = AnalyticBody::make_stack(e.entry, e.direction, {0});
  e.device = device;
  e.feel = options.feel;
  e.tissue = options.tissue;
  e.hand = hand;
  e.phases = {stay(0.3),   push_to(kDepth, kSpeed), stay(kHeld),
              let_go(0.4), pull_to(-4e-3, 0.02),    stay(0.2)};
  return run_body(e);
}

// One law over the seeds: a row of the table, and what the claims look at.
struct OverSeeds {
  std::vector<Measured> of_seed;

  template <class F>
  [[nodiscard]] std::vector<double> sorted(F value) const {
    std::vector<double> out;
    for (const Measured& m : of_seed) out.push_back(value(m));
    std::sort(out.begin(), out.end());
    return out;
  }
};

double middle(const std::vector<double>& sorted) {
  return sorted[sorted.size() / 2];
}

// A law that asks more than the device gives is not rendered: pinned to the limit, it cannot
// chatter.
bool is_rendered(const Measured& m) {
  constexpr double kShare = 0.01;
  return m.limited <= kShare;
}

// N^2 s above 20 Hz of the wall's own corners, in which no other law shares: where it reaches f_R,
// and both ends of the straight line by which it settles.
double wall_corners(double stiffness) {
  return corner_energy(stiffness * kSpeed, kHighPass) +
         2 * corner_energy(kForce / TrackingWallParams{}.settling_time, kHighPass);
}

// The wall's energy, less `corners`, over the best of the others that `counts`, seed by seed,
// rising.
template <class F, class Counts>
std::vector<double> ratios(const std::array<OverSeeds, kLaws.size()>& laws, F value, double corners,
                           Counts counts) {
  std::vector<double> out;
  for (std::size_t i = 0; i < laws[0].of_seed.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < laws.size(); ++k) {
      const Measured& other = laws[k].of_seed[i];
      if (counts(other)) least = std::min(least, value(other));
    }
    out.push_back(std::max(0.0, value(laws[0].of_seed[i]) - corners) / least);
  }
  std::sort(out.begin(), out.end());
  return out;
}

bool is_any(const Measured& /*m*/) {
  return true;
}

constexpr auto kEjection = [](const Measured& m) {
  return m.ejection / kMillimetre;
};
constexpr auto kMoved = [](const Measured& m) {
  return m.moved / kMillimetre;
};
constexpr auto kGuided = [](const Measured& m) {
  return m.guided;
};
constexpr auto kContact = [](const Measured& m) {
  return m.contact;
};
constexpr auto kLimited = [](const Measured& m) {
  return m.limited;
};
constexpr auto kEnergy = [](const Measured& m) {
  return m.energy;
};

void add_rows(const DeviceLimits& device, double stiffness,
              const std::array<OverSeeds, kLaws.size()>& laws, TextTable& table) {
  const std::vector<double> guided = ratios(laws, kGuided, 0, is_any);
  const std::vector<double> chatter = ratios(laws, kGuided, wall_corners(stiffness), is_rendered);
  const std::vector<double> contact = ratios(laws, kContact, 0, is_any);
  for (std::size_t k = 0; k < laws.size(); ++k) {
    const auto moved = laws[k].sorted(kMoved);
    table.rows.push_back(
        {std::string(device.name), to_string(kLaws[k]), to_csv(stiffness), to_csv(middle(moved)),
         to_csv(moved.back()), to_csv(laws[k].sorted(kEjection).back()),
         to_csv(middle(laws[k].sorted(kGuided))), to_csv(middle(laws[k].sorted(kContact))),
         to_csv(laws[k].sorted(kLimited).back()), to_csv(laws[k].sorted(kEnergy).back()),
         k == 0 ? to_csv(middle(guided)) : "", k == 0 ? to_csv(guided.back()) : "",
         k == 0 ? to_csv(chatter.back()) : "", k == 0 ? to_csv(contact.back()) : ""});
  }
}

// The time at which the tip first enters, s.
double entry_of(const std::vector<NeedleRow>& rows) {
  for (const NeedleRow& r : rows)
    if (r.depth > 0) return r.time;
  return rows.back().time;
}

// The force from 20 ms before the entry to 130 ms after it.
PlotSeries plot_entry(const std::vector<NeedleRow>& rows, const char* label) {
  PlotSeries series{label, {}, {}};
  const double entry = entry_of(rows);
  for (const NeedleRow& r : rows) {
    if (r.time < entry - 0.02 || r.time > entry + 0.13) continue;
    series.x.push_back(1e3 * (r.time - entry));
    series.y.push_back(r.command.force.z());
  }
  return series;
}

// How often the force falls by more than half of f_R from one tick to the next in the first 0.2 s.
int drops_on_entry(const std::vector<NeedleRow>& rows) {
  const double entry = entry_of(rows);
  int drops = 0;
  double before = 0;
  for (const NeedleRow& r : rows) {
    const double force = -r.command.force.z();
    if (r.time > entry && r.time < entry + 0.2 && before - force > 0.5 * kForce) ++drops;
    before = force;
  }
  return drops;
}

// Beside the source's figure: one hand on the chosen device, 500 N/m.
void add_published(CuttingLaw law, const std::vector<NeedleRow>& rows, const Measured& m,
                   std::vector<PublishedValue>& published) {
  const std::string name = to_string(law);
  const bool drawn = law == CuttingLaw::direct;
  const bool gradual = law == CuttingLaw::spring || law == CuttingLaw::voigt;
  published.push_back(
      {name + ": on entering",
       drawn     ? "chattering, the force changes suddenly"
       : gradual ? "the force increases gradually"
                 : "no chattering",
       "the force drops out " + std::to_string(drops_on_entry(rows)) + " times in 0.2 s"});
  published.push_back({name + ": when let go after a stop",
                       law == CuttingLaw::tracking_wall ? "keeps its position"
                       : law == CuttingLaw::voigt       ? "not shown"
                                                        : "the tool is rejected, no figure printed",
                       "moves out by " + to_csv(1e-3 * std::round(1e3 * kMoved(m))) + " mm"});
}

// What the claims look at, the worst of all devices and seeds.
struct WorstOfDevices {
  std::array<double, 3> rejected{};  // mm, least that the direct law and the spring push out by
  double moved = 0;                  // mm, by the wall
  double calm = 0;                   // mm, by the wall, of a hand that does not tremble
  double guided = 0;                 // chatter until the release over that of the best other law
  double contact = 0;                // over the whole cycle
  double energy = -std::numeric_limits<double>::infinity();  // J
};

void add_device(const std::array<OverSeeds, kLaws.size()>& laws, const Measured& calm,
                WorstOfDevices& worst) {
  for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
    const double least = laws[k].sorted(kMoved).front();
    worst.rejected[k] = worst.rejected[k] == 0 ? least : std::min(worst.rejected[k], least);
  }
  worst.moved = std::max(worst.moved, laws[0].sorted(kMoved).back());
  worst.calm = std::max(worst.calm, kMoved(calm));
  worst.guided = std::max(worst.guided, ratios(laws, kGuided, 0, is_any).back());
  worst.contact = std::max(worst.contact, ratios(laws, kContact, 0, is_any).back());
  worst.energy = std::max(worst.energy, laws[0].sorted(kEnergy).back());
}

void add_claims(double stiffness, const WorstOfDevices& worst, std::vector<Claim>& claims) {
  const std::string at = " at " + to_csv(stiffness) + " N/m, worst device and seed: ";
  for (const std::size_t k : {std::size_t{1}, std::size_t{2}})
    claims.push_back(claim_at_least(ClaimKind::independent,
                                    to_string(kLaws[k]) + at + "rejected by", worst.rejected[k], 2,
                                    "mm"));
  const std::string wall = "tracking wall" + at;
  claims.push_back(
      claim_at_most(ClaimKind::independent, wall + "ejection", worst.moved, 0.2, "mm"));
  claims.push_back(claim_at_most(ClaimKind::independent, wall + "ejection, a hand without tremor",
                                 worst.calm, 0.2, "mm"));
  claims.push_back(
      claim_at_most(ClaimKind::independent,
                    wall + "force energy above 20 Hz until the release over the best of the others",
                    worst.guided, 1, ""));
  claims.push_back(
      claim_at_most({ClaimKind::fitted, "the release was taken in after the former had been seen"},
                    wall + "the same over the whole cycle", worst.contact, 1, ""));
  claims.push_back(claim_at_most({ClaimKind::input, "the wall is built to give none"},
                                 wall + "energy given over the cycle", worst.energy, 0, "J"));
}

// What is drawn and kept of one law on the chosen device, 500 N/m.
struct Panels {
  PlotPanel position{"time (s)", "tip (mm), K = 500 N/m", {}};
  PlotPanel force{"time (s)", "force on the hand (N), K = 500 N/m", {}};
  PlotPanel entry{"time since the entry (ms)", "force on the hand (N)", {}};

  void add(CuttingLaw law, const std::vector<NeedleRow>& rows) {
    const char* label = to_string(law);
    position.series.push_back(plot_rows(rows, label, [](const NeedleRow& r) {
      return (r.X_JN.translation().z() - 0.12) / kMillimetre;
    }));
    force.series.push_back(
        plot_rows(rows, label, [](const NeedleRow& r) { return r.command.force.z(); }));
    entry.series.push_back(plot_entry(rows, label));
  }
};

// One device and stiffness: the laws over the seeds; traces and panels of the chosen device.
std::array<OverSeeds, kLaws.size()> run_laws(const DeviceLimits& device, double stiffness,
                                             const ExperimentOptions& options, Panels* panels,
                                             Experiment& out) {
  std::array<OverSeeds, kLaws.size()> laws;
  for (std::size_t k = 0; k < kLaws.size(); ++k) {
    for (std::uint64_t i = 0; i < kSeeds; ++i) {
      HandParams hand;
      hand.seed = options.seed + i;
      std::vector<NeedleRow> rows = run_release(kLaws[k], stiffness, device, options, hand);
      laws[k].of_seed.push_back(measure(rows, 1000, device));
      if (i != 0 || panels == nullptr) continue;
      if (stiffness == 500) {
        panels->add(kLaws[k], rows);
        add_published(kLaws[k], rows, laws[k].of_seed.back(), out.published);
      }
      out.traces.push_back({std::string(to_string(kLaws[k])) + "-" + to_csv(stiffness),
                            std::move(rows), layer_names(1)});
    }
  }
  return laws;
}

TextTable make_table() {
  return {{"device", "law", "K_n_m", "moved_out_mm_median", "moved_out_mm_worst",
           "beyond_momentum_mm_worst", "until_release_n2s_median", "in_contact_n2s_median",
           "at_device_limit_share_worst", "energy_to_hand_j_worst",
           "until_release_over_best_other_median", "until_release_over_best_other_worst",
           "less_corners_over_best_rendered_worst", "in_contact_over_best_other_worst"},
          {}};
}

}  // namespace

Experiment run_wall_vs_classic(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out;
  out.title = "Direct, spring, Voigt and tracking wall: stop, then let go";
  out.source = "[Alamilla2020] Figs. 2-4a (direct) and 2-4b (spring), section 2.2";
  TextTable table = make_table();
  Panels panels;
  std::array<WorstOfDevices, kStiffnesses.size()> worst;
  for (const DeviceLimits& each : device_table()) {
    for (std::size_t i = 0; i < kStiffnesses.size(); ++i) {
      const auto laws = run_laws(each, kStiffnesses[i], options,
                                 each.name == device.name ? &panels : nullptr, out);
      add_rows(each, kStiffnesses[i], laws, table);
      HandParams calm;
      calm.tremor_rms = 0;
      const auto rows =
          run_release(CuttingLaw::tracking_wall, kStiffnesses[i], each, options, calm);
      add_device(laws, measure(rows, 1000, each), worst[i]);
    }
  }
  for (std::size_t i = 0; i < kStiffnesses.size(); ++i)
    add_claims(kStiffnesses[i], worst[i], out.claims);
  out.assumed = assumed_with_hand(
      {"depth 6 mm, speed 10 mm/s, 1.5 s of rest; 1 N in a tissue that only cuts",
       "Voigt's damping, 5 N s/m", "2 mm, from which on a needle counts as rejected",
       "the filter: Butterworth, order 8, 20 Hz"});
  out.tables = {{"", std::move(table)}};
  out.plots = {{"", {out.title + " (Fig. 2-4)", {panels.position, panels.force, panels.entry}}}};
  return out;
}

}  // namespace artus
