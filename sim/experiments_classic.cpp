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
  double chatter = 0;   // N^2 s above 20 Hz, in contact until the release
  double energy = 0;    // J given to the hand over insertion, release, withdrawal
};

Measured measure(const std::vector<NeedleRow>& rows, double rate, double release, double regrip) {
  Measured m;
  HighPass filter(kHighPass, rate);
  double at_release = 0;
  double least = 1;
  for (const NeedleRow& r : rows) {
    const double high = filter.step(r.command.force.dot(Vec3::UnitZ()));
    if (r.time < release) {
      if (r.depth > 0) m.chatter += high * high / rate;
      at_release = r.X_JN.translation().z();
    } else if (r.time < regrip) {
      least = std::min(least, r.X_JN.translation().z());
    }
  }
  m.ejection = std::max(0.0, at_release - least);
  m.energy = rows.back().energy_to_hand;
  return m;
}

// When the hand let go and when it took the needle again: its force is exactly zero between.
std::pair<double, double> released(const std::vector<NeedleRow>& rows) {
  double from = 0;
  double to = 0;
  for (const NeedleRow& r : rows) {
    if (r.time == 0 || r.hand.norm() > 0) continue;
    if (from == 0) from = r.time;
    to = r.time;
  }
  return {from, to};
}

}  // namespace

Experiment run_wall_vs_classic(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out;
  out.title = "Direct, spring, Voigt and tracking wall: stop, then let go (source Fig. 2-4)";
  out.table.header = {"law", "K_n_m", "ejection_mm", "chatter_n2s", "energy_to_hand_j"};
  PlotPanel position{"time (s)", "tip (mm), K = 500 N/m", {}};
  PlotPanel force{"time (s)", "force on the hand (N), K = 500 N/m", {}};
  for (const double stiffness : {500.0, 1000.0, 2000.0}) {
    Measured wall;
    double least = 1e9;
    for (const CuttingLaw law :
         {CuttingLaw::tracking_wall, CuttingLaw::direct, CuttingLaw::spring, CuttingLaw::voigt}) {
      BodyExperiment e;
      e.layers = {plain_layer(1, stiffness)};
      e.layers[0].cutting = law;
      e.entry = Vec3(0, 0, 0.12);
      e.body = AnalyticBody::make_stack(e.entry, e.direction, {0});
      e.device = device;
      e.hand.seed = options.seed;
      e.phases = {stay(0.3),   push_to(kDepth, 0.01), stay(kHeld),
                  let_go(0.4), pull_to(-4e-3, 0.02),  stay(0.2)};
      ExperimentTrace trace{std::string(to_string(law)) + "-" + to_csv(stiffness), run_body(e),
                            layer_names(1)};
      const auto [release, regrip] = released(trace.rows);
      const Measured m = measure(trace.rows, e.rate_hz, release, regrip);
      out.table.rows.push_back({to_string(law), to_csv(stiffness), to_csv(m.ejection / kMillimetre),
                                to_csv(m.chatter), to_csv(m.energy)});
      if (law == CuttingLaw::tracking_wall)
        wall = m;
      else
        least = std::min(least, m.chatter);
      if (law == CuttingLaw::direct || law == CuttingLaw::spring) {
        out.claims.push_back(claim_at_least(
            std::string(to_string(law)) + " at " + to_csv(stiffness) + " N/m: ejection",
            m.ejection / kMillimetre, 2, "mm"));
      }
      if (stiffness == 500) {
        position.series.push_back(plot_rows(trace.rows, to_string(law), [](const NeedleRow& r) {
          return (r.X_JN.translation().z() - 0.12) / kMillimetre;
        }));
        force.series.push_back(plot_rows(trace.rows, to_string(law),
                                         [](const NeedleRow& r) { return r.command.force.z(); }));
      }
      out.traces.push_back(std::move(trace));
    }
    const std::string at = "tracking wall at " + to_csv(stiffness) + " N/m: ";
    out.claims.push_back(claim_at_most(at + "ejection", wall.ejection / kMillimetre, 0.2, "mm"));
    out.claims.push_back(claim_at_most(at + "force energy above 20 Hz over the best of the others",
                                       wall.chatter / least, 1, ""));
    out.claims.push_back(claim_at_most(at + "energy given over the cycle", wall.energy, 0, "J"));
  }
  out.plot.title = out.title;
  out.plot.panels = {position, force};
  return out;
}

Experiment run_wall_energy(const ExperimentOptions& options, const DeviceLimits& /*device*/) {
  constexpr std::uint64_t kHistories = 10000;
  constexpr std::uint64_t kTicks = 500;
  Experiment out;
  out.title = "Energy given to the hand over 10 000 random insertion histories through six layers";
  const std::vector<double> begins{0, 2e-3, 5e-3, 6e-3, 8e-3, 9e-3};
  std::vector<LayerHaptics> layers(kFirstRegion);
  const std::array<double, 5> forces{1, 2, 1.5, 2.5, 3};
  const std::array<double, 5> stiffness{1500, 500, 1000, 400, 2000};
  for (std::size_t i = 0; i < forces.size(); ++i) {
    layers.push_back(plain_layer(forces[i], stiffness[i], 0.3 * forces[i]));
  }
  layers.push_back(bone_layer(4, 4000));
  const LayerTable table(layers);
  const AnalyticBody body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), begins);
  std::array<TissueInterval, 32> buffer{};
  PlotSeries given{"energy given", {}, {}, "dots"};
  double most = -1e9;
  for (std::uint64_t h = 0; h < kHistories; ++h) {
    const std::uint64_t seed = options.seed * 1000003 + h;
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
      const NeedleForces& f = model.forces();
      force = f.cutting + f.attracted;
    }
    energy += force * (-2e-3 - z);
    most = std::max(most, energy);
    given.x.push_back(static_cast<double>(h));
    given.y.push_back(energy);
  }
  out.claims = {claim_at_most("most energy given over a closed cycle, of 10 000", most, 0, "J")};
  out.plot.title = out.title;
  out.plot.panels = {{"history", "energy given to the hand (J)", {given}}};
  return out;
}

}  // namespace artus
