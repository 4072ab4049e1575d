// SPDX-License-Identifier: AGPL-3.0-or-later
// The tracking wall beside the methods it replaces, and its energy over random insertions.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/noise.h"
#include "core/units.h"
#include "sim/experiment_list.h"

namespace artus {
namespace {

constexpr double kHighPass = 20;  // Hz
constexpr double kDepth = 6e-3;   // m of intended insertion
constexpr double kHeld = 1.5;     // s

// Second-order Butterworth high-pass (bilinear), as a direct form II transposed filter.
class HighPass {
 public:
  HighPass(double cut_hz, double rate_hz) {
    const double k = std::tan(3.141592653589793 * cut_hz / rate_hz);
    const double norm = 1 / (1 + std::sqrt(2.0) * k + k * k);
    b_ = {norm, -2 * norm, norm};
    a_ = {2 * (k * k - 1) * norm, (1 - std::sqrt(2.0) * k + k * k) * norm};
  }
  double step(double x) {
    const double y = b_[0] * x + s_[0];
    s_[0] = b_[1] * x - a_[0] * y + s_[1];
    s_[1] = b_[2] * x - a_[1] * y;
    return y;
  }

 private:
  std::array<double, 3> b_{};
  std::array<double, 2> a_{};
  std::array<double, 2> s_{};
};

struct Measured {
  double ejection = 0;  // m the needle comes out after the release
  double guided = 0;    // N^2 s above 20 Hz, in contact until the release
  double contact = 0;   // N^2 s above 20 Hz, in contact over the whole cycle
  double energy = 0;    // J given to the hand over insertion, release, withdrawal
};

Measured measure(const std::vector<NeedleRow>& rows, double rate, double release, double regrip) {
  Measured m;
  HighPass filter(kHighPass, rate);
  double at_release = 0;
  double least = 1;
  for (const NeedleRow& r : rows) {
    const double high = filter.step(r.command.force.dot(Vec3::UnitZ()));
    const double share = r.depth > 0 ? high * high / rate : 0;
    m.contact += share;
    if (r.time < release) {
      m.guided += share;
      at_release = r.X_JN.translation().z();
    } else if (r.time < regrip) {
      least = std::min(least, r.X_JN.translation().z());
    }
  }
  m.ejection = std::max(0.0, at_release - least);
  m.energy = rows.back().energy_to_hand;
  return m;
}

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

constexpr std::array<CuttingLaw, 4> kLaws{CuttingLaw::tracking_wall, CuttingLaw::direct,
                                          CuttingLaw::spring, CuttingLaw::voigt};
constexpr std::uint64_t kSeeds = 10;

std::vector<NeedleRow> run_release(CuttingLaw law, double stiffness, const DeviceLimits& device,
                                   std::uint64_t seed) {
  BodyExperiment e;
  e.layers = {plain_layer(1, stiffness)};
  e.layers[0].cutting = law;
  e.entry = Vec3(0, 0, 0.12);
  e.body = AnalyticBody::make_stack(e.entry, e.direction, {0});
  e.device = device;
  e.hand.seed = seed;
  e.phases = {stay(0.3),   push_to(kDepth, 0.01), stay(kHeld),
              let_go(0.4), pull_to(-4e-3, 0.02),  stay(0.2)};
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

// The wall's energy over the best of the others, seed by seed, rising.
template <class F>
std::vector<double> ratios(const std::array<OverSeeds, kLaws.size()>& laws, F value) {
  std::vector<double> out;
  for (std::size_t i = 0; i < laws[0].of_seed.size(); ++i) {
    double least = value(laws[1].of_seed[i]);
    for (std::size_t k = 2; k < laws.size(); ++k)
      least = std::min(least, value(laws[k].of_seed[i]));
    out.push_back(value(laws[0].of_seed[i]) / least);
  }
  std::sort(out.begin(), out.end());
  return out;
}

constexpr auto kEjection = [](const Measured& m) {
  return m.ejection / kMillimetre;
};
constexpr auto kGuided = [](const Measured& m) {
  return m.guided;
};
constexpr auto kContact = [](const Measured& m) {
  return m.contact;
};
constexpr auto kEnergy = [](const Measured& m) {
  return m.energy;
};

void add_rows(const DeviceLimits& device, double stiffness,
              const std::array<OverSeeds, kLaws.size()>& laws, ExperimentTable& table) {
  const std::vector<double> guided = ratios(laws, kGuided);
  const std::vector<double> contact = ratios(laws, kContact);
  for (std::size_t k = 0; k < laws.size(); ++k) {
    const auto ejection = laws[k].sorted(kEjection);
    table.rows.push_back(
        {std::string(device.name), to_string(kLaws[k]), to_csv(stiffness), to_csv(middle(ejection)),
         to_csv(ejection.back()), to_csv(middle(laws[k].sorted(kGuided))),
         to_csv(middle(laws[k].sorted(kContact))), to_csv(laws[k].sorted(kEnergy).back()),
         k == 0 ? to_csv(middle(guided)) : "", k == 0 ? to_csv(guided.back()) : "",
         k == 0 ? to_csv(contact.back()) : ""});
  }
}

void add_claims(double stiffness, const std::array<OverSeeds, kLaws.size()>& laws,
                std::vector<Claim>& claims) {
  const std::string at = " at " + to_csv(stiffness) + " N/m, worst seed: ";
  for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
    claims.push_back(claim_at_least(to_string(kLaws[k]) + at + "ejection",
                                    laws[k].sorted(kEjection).front(), 2, "mm"));
  }
  const std::string wall = "tracking wall" + at;
  claims.push_back(claim_at_most(wall + "ejection", laws[0].sorted(kEjection).back(), 0.2, "mm"));
  claims.push_back(claim_at_most(wall + "force energy above 20 Hz over the best of the others",
                                 ratios(laws, kContact).back(), 1, ""));
  claims.push_back(
      claim_at_most(wall + "energy given over the cycle", laws[0].sorted(kEnergy).back(), 0, "J"));
}

}  // namespace

Experiment run_wall_vs_classic(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out;
  out.title = "Direct, spring, Voigt and tracking wall: stop, then let go (source Fig. 2-4)";
  out.table.header = {"device",
                      "law",
                      "K_n_m",
                      "ejection_mm_median",
                      "ejection_mm_worst",
                      "until_release_n2s_median",
                      "in_contact_n2s_median",
                      "energy_to_hand_j_worst",
                      "until_release_over_best_other_median",
                      "until_release_over_best_other_worst",
                      "in_contact_over_best_other_worst"};
  PlotPanel position{"time (s)", "tip (mm), K = 500 N/m", {}};
  PlotPanel force{"time (s)", "force on the hand (N), K = 500 N/m", {}};
  for (const DeviceLimits& each : device_table()) {
    for (const double stiffness : {500.0, 1000.0, 2000.0}) {
      std::array<OverSeeds, kLaws.size()> laws;
      for (std::size_t k = 0; k < kLaws.size(); ++k) {
        for (std::uint64_t i = 0; i < kSeeds; ++i) {
          std::vector<NeedleRow> rows = run_release(kLaws[k], stiffness, each, options.seed + i);
          const auto [release, regrip] = released(rows);
          laws[k].of_seed.push_back(measure(rows, 1000, release, regrip));
          if (i != 0 || each.name != device.name) continue;
          if (stiffness == 500) {
            const char* label = to_string(kLaws[k]);
            position.series.push_back(plot_rows(rows, label, [](const NeedleRow& r) {
              return (r.X_JN.translation().z() - 0.12) / kMillimetre;
            }));
            force.series.push_back(
                plot_rows(rows, label, [](const NeedleRow& r) { return r.command.force.z(); }));
          }
          out.traces.push_back({std::string(to_string(kLaws[k])) + "-" + to_csv(stiffness),
                                std::move(rows), layer_names(1)});
        }
      }
      add_rows(each, stiffness, laws, out.table);
      if (each.name == device.name) add_claims(stiffness, laws, out.claims);
    }
  }
  out.plot.title = out.title;
  out.plot.panels = {position, force};
  return out;
}

namespace {

constexpr std::uint64_t kHistories = 10000;

// Five soft layers and bone; with friction and two membranes, or the wall alone.
LayerTable random_layers(bool all_laws) {
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
  return LayerTable(std::move(layers));
}

// J given to the hand by the total force over one random walk from outside the skin and back.
double energy_of_history(const LayerTable& table, const AnalyticBody& body, std::uint64_t seed) {
  constexpr std::uint64_t kTicks = 500;
  std::array<TissueInterval, 32> buffer{};
  NeedleModel model(NeedleParams{}, table, 1e-3);
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
  out.plot.title = out.title;
  const AnalyticBody body =
      AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, 2e-3, 5e-3, 6e-3, 8e-3, 9e-3});
  PlotPanel panel{"history", "energy given to the hand (J)", {}};
  for (const bool all_laws : {true, false}) {
    const LayerTable table = random_layers(all_laws);
    const std::string what = all_laws ? "wall, friction, membranes" : "wall alone";
    PlotSeries given{what, {}, {}, "points pt 7 ps 0.2"};
    for (std::uint64_t h = 0; h < kHistories; ++h) {
      given.x.push_back(static_cast<double>(h));
      given.y.push_back(energy_of_history(table, body, options.seed * 1000003 + h));
    }
    out.claims.push_back(claim_at_most(what + ": most energy given over a closed cycle, of 10 000",
                                       *std::max_element(given.y.begin(), given.y.end()), 0, "J"));
    panel.series.push_back(std::move(given));
  }
  out.plot.panels = {std::move(panel)};
  return out;
}

}  // namespace artus
