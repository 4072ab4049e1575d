// SPDX-License-Identifier: AGPL-3.0-or-later
// What the laws give to the hand over random insertions.
#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/core/noise.h"
#include "artus/detail/evidence/validation/needle/experiments.h"

namespace artus {
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
                         const AnalyticBody& body, const NeedleCompliance& tissue,
                         std::uint64_t seed) {
  constexpr std::uint64_t kTicks = 500;
  std::array<TissueInterval, 32> buffer{};
  NeedleModel model(needle, table, 1e-3);
  model.take({{}, tissue});
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
    const QueryCount met = body.find_intervals(model.query_segment(pose), buffer);
    model.step(pose, std::span<const TissueInterval>(buffer.data(), met.size));
    force = model.forces().total.force.z();
  }
  return energy + force * (-2e-3 - z);
}

}  // namespace

Experiment run_wall_energy(const ExperimentOptions& options, const DeviceLimits& /*device*/) {
  Experiment out;
  out.title = "Energy given to the hand over 10 000 random insertion histories through six layers";
  out.source = "[Hannaford2002] for the observer; the source of the laws shows no such test";
  const AnalyticBody body =
      AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, 2e-3, 5e-3, 6e-3, 8e-3, 9e-3});
  NeedleParams needle;
  apply(options.feel, needle);
  PlotPanel panel{"history", "energy given to the hand (J)", {}};
  for (const bool all_laws : {true, false}) {
    const LayerTable table = random_layers(all_laws, options.feel);
    const std::string what = all_laws ? "wall, friction, membranes" : "wall alone";
    PlotSeries given{what, {}, {}, PlotStyle::dots};
    for (std::uint64_t h = 0; h < kHistories; ++h) {
      given.x.push_back(static_cast<double>(h));
      given.y.push_back(
          energy_of_history(table, needle, body, options.tissue, options.seed * 1000003 + h));
    }
    out.claims.push_back(claim_at_most({ClaimKind::input, "the laws are built to give none"},
                                       what + ": most energy given over a closed cycle, of 10 000",
                                       *std::max_element(given.y.begin(), given.y.end()), 0, "J"));
    panel.series.push_back(std::move(given));
  }
  out.assumed = {
      "the layers' forces and stiffnesses, and what a random history is: steps of at "
      "most 0.3 mm towards goals within 11 mm"};
  out.plots = {{"", {out.title, {std::move(panel)}}}};
  return out;
}

}  // namespace artus
