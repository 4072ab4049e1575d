// SPDX-License-Identifier: AGPL-3.0-or-later
// The tracking wall beside the methods it replaces, and its energy over random insertions.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "artus/core/csv.h"
#include "artus/core/noise.h"
#include "artus/core/units.h"
#include "artus/evidence/needle/experiment_list.h"
#include "artus/evidence/needle/high_pass.h"
#include "artus/evidence/needle/release.h"

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

// `calm`: the wall and a hand that does not tremble.
void add_claims(double stiffness, const std::array<OverSeeds, kLaws.size()>& laws,
                const Measured& calm, std::vector<Claim>& claims) {
  const std::string at = " at " + to_csv(stiffness) + " N/m, worst seed: ";
  for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
    claims.push_back(claim_at_least(ClaimKind::independent, to_string(kLaws[k]) + at + "ejection",
                                    laws[k].sorted(kEjection).front(), 2, "mm"));
  }
  const std::string wall = "tracking wall" + at;
  claims.push_back(claim_at_most(ClaimKind::independent,
                                 wall + "ejection, beyond the momentum of the hand's tremor",
                                 laws[0].sorted(kEjection).back(), 0.2, "mm"));
  claims.push_back(claim_at_most(
      ClaimKind::independent,
      "tracking wall at " + to_csv(stiffness) + " N/m, a hand without tremor: ejection",
      calm.moved / kMillimetre, 0.2, "mm"));
  claims.push_back(claim_at_most(ClaimKind::independent,
                                 wall + "force energy above 20 Hz over the best of the others",
                                 ratios(laws, kContact, 0, is_any).back(), 1, ""));
  claims.push_back(claim_at_most(ClaimKind::independent,
                                 wall + "the same until the release, less the wall's own corners, "
                                        "laws at the device's limit left out",
                                 ratios(laws, kGuided, wall_corners(stiffness), is_rendered).back(),
                                 1, ""));
  claims.push_back(claim_at_most(ClaimKind::independent, wall + "energy given over the cycle",
                                 laws[0].sorted(kEnergy).back(), 0, "J"));
}

}  // namespace

Experiment run_wall_vs_classic(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out;
  out.title = "Direct, spring, Voigt and tracking wall: stop, then let go";
  out.source = "[Alamilla2020] Figs. 2-4a (direct) and 2-4b (spring), section 2.2";
  out.table.header = {"device",
                      "law",
                      "K_n_m",
                      "moved_out_mm_median",
                      "moved_out_mm_worst",
                      "beyond_momentum_mm_worst",
                      "until_release_n2s_median",
                      "in_contact_n2s_median",
                      "at_device_limit_share_worst",
                      "energy_to_hand_j_worst",
                      "until_release_over_best_other_median",
                      "until_release_over_best_other_worst",
                      "less_corners_over_best_rendered_worst",
                      "in_contact_over_best_other_worst"};
  PlotPanel position{"time (s)", "tip (mm), K = 500 N/m", {}};
  PlotPanel force{"time (s)", "force on the hand (N), K = 500 N/m", {}};
  PlotPanel entry{"time since the entry (ms)", "force on the hand (N)", {}};
  for (const DeviceLimits& each : device_table()) {
    for (const double stiffness : {500.0, 1000.0, 2000.0}) {
      std::array<OverSeeds, kLaws.size()> laws;
      for (std::size_t k = 0; k < kLaws.size(); ++k) {
        for (std::uint64_t i = 0; i < kSeeds; ++i) {
          HandParams hand;
          hand.seed = options.seed + i;
          std::vector<NeedleRow> rows = run_release(kLaws[k], stiffness, each, options, hand);
          laws[k].of_seed.push_back(measure(rows, 1000, each));
          if (i != 0 || each.name != device.name) continue;
          if (stiffness == 500) {
            const char* label = to_string(kLaws[k]);
            position.series.push_back(plot_rows(rows, label, [](const NeedleRow& r) {
              return (r.X_JN.translation().z() - 0.12) / kMillimetre;
            }));
            force.series.push_back(
                plot_rows(rows, label, [](const NeedleRow& r) { return r.command.force.z(); }));
            entry.series.push_back(plot_entry(rows, label));
            add_published(kLaws[k], rows, laws[k].of_seed.back(), out.published);
          }
          out.traces.push_back({std::string(to_string(kLaws[k])) + "-" + to_csv(stiffness),
                                std::move(rows), layer_names(1)});
        }
      }
      add_rows(each, stiffness, laws, out.table);
      if (each.name != device.name) continue;
      HandParams calm;
      calm.tremor_rms = 0;
      const auto rows = run_release(CuttingLaw::tracking_wall, stiffness, each, options, calm);
      add_claims(stiffness, laws, measure(rows, 1000, each), out.claims);
    }
  }
  out.plot.title = out.title + " (Fig. 2-4)";
  out.plot.panels = {position, force, entry};
  return out;
}

namespace {

constexpr std::uint64_t kHistories = 10000;

// Five soft layers and bone; with friction and two membranes, or the wall alone.
LayerTable random_layers(bool all_laws, const NeedleFeel& feel) {
  std::vector<LayerHaptics> layers(kFirstRegion);
  const std::array<double, 5> forces{1, 2, 1.5, 2.5, 3};
  const std::array<double, 5> stiffness{1500, 500, 1000, 400, 2000};
  for (std::size_t i = 0; i < forces.size(); ++i) {
    layers.push_back(plain_layer(forces[i], stiffness[i], 0.3 * forces[i]));
    layers.back().tissue.friction = all_laws ? 1 : 0;
  }
  if (all_laws) {
    layers[kFirstRegion].tissue.puncture_force = 1.5;
    layers[kFirstRegion + 2].tissue.puncture_force = 2;
  }
  layers.push_back(bone_layer(4, 4000));
  const auto names = numbered_layers(6);
  for (std::size_t i = 0; i < names.size(); ++i) apply(feel, names[i], layers[kFirstRegion + i]);
  return LayerTable(std::move(layers));
}

// J given to the hand by the total force over one random walk from outside the skin and back.
double energy_of_history(const LayerTable& table, const NeedleParams& needle,
                         const AnalyticBody& body, std::uint64_t seed) {
  constexpr std::uint64_t kTicks = 500;
  std::array<TissueInterval, 32> buffer{};
  NeedleModel model(needle, table, 1e-3);
  double z = -1e-4;
  double goal = 0;
  double energy = 0;
  double force = 0;
  for (std::uint64_t i = 0; i < kTicks; ++i) {
    if (i % 40 == 0) goal = i + 60 < kTicks ? 11e-3 * uniform_noise(seed, 2 * i) : -1e-3;
    const double step = 3e-4 * uniform_noise(seed, 2 * i + 1);
    const double next = std::abs(goal - z) < step ? goal : z + std::copysign(step, goal - z);
    energy += force * (next - z);
    z = next;
    const Pose pose = make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX());
    model.step(pose, body.find_intervals(model.query_segment(pose), buffer));
    force = model.forces().total.force.z();
  }
  return energy + force * (-2e-3 - z);
}

}  // namespace

Experiment run_wall_energy(const ExperimentOptions& options, const DeviceLimits& /*device*/) {
  Experiment out;
  out.title = "Energy given to the hand over 10 000 random insertion histories through six layers";
  out.source = "[Hannaford2002] for the observer; the source of the laws shows no such test";
  out.plot.title = out.title;
  const AnalyticBody body =
      AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, 2e-3, 5e-3, 6e-3, 8e-3, 9e-3});
  NeedleParams needle;
  apply(options.feel, needle);
  PlotPanel panel{"history", "energy given to the hand (J)", {}};
  for (const bool all_laws : {true, false}) {
    const LayerTable table = random_layers(all_laws, options.feel);
    const std::string what = all_laws ? "wall, friction, membranes" : "wall alone";
    PlotSeries given{what, {}, {}, "points pt 7 ps 0.2"};
    for (std::uint64_t h = 0; h < kHistories; ++h) {
      given.x.push_back(static_cast<double>(h));
      given.y.push_back(energy_of_history(table, needle, body, options.seed * 1000003 + h));
    }
    out.claims.push_back(claim_at_most(ClaimKind::independent,
                                       what + ": most energy given over a closed cycle, of 10 000",
                                       *std::max_element(given.y.begin(), given.y.end()), 0, "J"));
    panel.series.push_back(std::move(given));
  }
  out.plot.panels = {std::move(panel)};
  return out;
}

}  // namespace artus
