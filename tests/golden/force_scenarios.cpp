// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/golden/force_scenarios.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/needle/experiment_body.h"
#include "artus/detail/haptics/needle/needle_tick_step.h"

namespace artus::test {
namespace {

constexpr double kMm = kMillimetre;

// ---- the body: skin to 2 mm, muscle to 14, bursa to 16, fat to 24, then bone; a little off those,
// so that no tick ends on a surface and rounding decides nothing

AnalyticBody flat_layers() {
  return AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(),
                                  {0, 2.0371 * kMm, 14.0173 * kMm, 16.0297 * kMm, 24.0119 * kMm});
}

Haptic tissue(double cutting, double stiffness, double clamping, double puncture = 0) {
  Haptic haptic;
  haptic.cutting_force = cutting;
  haptic.wall_stiffness = stiffness;
  haptic.attracted_force = 0.3 * cutting;
  haptic.friction = 0.9;
  haptic.clamping_stiffness = clamping;
  haptic.puncture_force = puncture;
  return haptic;
}

ForceSetup plain_setup() {
  ForceSetup setup;
  setup.device = *find_device("virtuose_6d_desktop");
  setup.skin = tissue(1, 1500, 120, 1.2);
  setup.muscle = tissue(2, 800, 250);
  setup.bursa = tissue(1.5, 500, 150, 2.2);
  setup.fat = tissue(0.8, 400, 100);
  setup.bone = tissue(4, 4000, 50, 0.7);
  setup.bone.hard = true;
  return setup;
}

LayerHaptics layer_of(const Haptic& haptic) {
  return {haptic, haptic.cutting_law, haptic.prepuncture_law};
}

std::vector<LayerHaptics> layers_of(const ForceSetup& s) {
  return {layer_of(s.skin), layer_of(s.muscle), layer_of(s.bursa), layer_of(s.fat),
          layer_of(s.bone)};
}

// ---- prescribed ways, through the whole tick

struct Key {
  double time = 0;  // s
  double depth = 0;
  double side = 0;
  double tilt = 0;  // rad
};

struct Path {
  std::vector<Key> keys;  // straight in between; mm until make_way has made them m
  Vec3 direction = Vec3::UnitZ();
  double rate_hz = 1000;
  double frozen_from = 1e9;  // s, from which the pose's time stands still
  double frozen_to = 1e9;
};

Key at(const Path& displacement, double t) {
  std::size_t i = 1;
  while (i + 1 < displacement.keys.size() && displacement.keys[i].time <= t) ++i;
  const Key& a = displacement.keys[i - 1];
  const Key& b = displacement.keys[i];
  const double share = std::clamp((t - a.time) / (b.time - a.time), 0.0, 1.0);
  return {t, kMm * (a.depth + share * (b.depth - a.depth)),
          kMm * (a.side + share * (b.side - a.side)), a.tilt + share * (b.tilt - a.tilt)};
}

std::vector<NeedleRow> follow(const AnalyticBody& body, const Path& displacement,
                              const ForceSetup& setup) {
  std::vector<LayerHaptics> by_region(kFirstRegion);
  for (const LayerHaptics& layer : layers_of(setup)) by_region.push_back(layer);
  NeedleTickStep tick(LayerTable(std::move(by_region)), {setup.needle, setup.guard, setup.passivity,
                                                         setup.device, displacement.rate_hz});
  const Vec3 direction = displacement.direction.normalized();
  const Vec3 side = make_pose(Vec3::Zero(), direction, Vec3::UnitX()).linear().col(0);
  std::vector<NeedleRow> rows;
  const auto n = static_cast<long>(displacement.keys.back().time * displacement.rate_hz);
  for (long i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / displacement.rate_hz;
    const Key k = at(displacement, t);
    const Vec3 axis = std::cos(k.tilt) * direction + std::sin(k.tilt) * side;
    const Pose X_JN = make_pose(k.depth * direction + k.side * side, axis, side.cross(axis));
    const double time =
        t >= displacement.frozen_from && t < displacement.frozen_to ? displacement.frozen_from : t;
    const RenderedNeedle& rendered = tick.step({X_JN, time}, body);
    rows.push_back(make_needle_row(t, X_JN, rendered, tick.model()));
    rows.back().energy_to_hand = rendered.energy_to_hand;
  }
  return rows;
}

ForceScenario prescribed(const std::string& name, const ForceSetup& setup, const Path& displacement,
                         const AnalyticBody& body = flat_layers()) {
  return {name, setup, [body, displacement](const ForceSetup& s) {
            return follow(body, displacement, s);
          }};
}

/// In through skin, muscle and bursa, with stops, on bone, and out.
Path insertion() {
  return {{{0, -3, 0, 0},
           {0.1, -1, 0, 0},
           {0.4, 1, 0, 0},
           {0.9, 10, 0, 0},
           {1.3, 10, 0, 0},
           {1.7, 15.3, 0, 0},
           {1.9, 19, 0, 0},
           {2.1, 19, 0, 0},  // a short stop, and another before the wall is ready again
           {2.15, 20, 0, 0},
           {2.4, 20, 0, 0},
           {2.5, 17, 0, 0},
           {2.8, 24.9, 0, 0},
           {3.0, 24.9, 0, 0},
           {3.1, 23.4969, 0, 0},  // back by little more than what arms the tap anew
           {3.15, 24.4, 0, 0},
           {3.5, 18, 0, 0},
           {3.8, -3, 0, 0}},
          Vec3::UnitZ()};
}

ForceScenario tracking_wall() {
  return prescribed("tracking-wall", plain_setup(), insertion());
}

ForceScenario bent_aside() {
  return prescribed("bent-aside", plain_setup(),
                    {{{0, -1, 0, 0},
                      {0.3, 12, 0, 0},
                      {0.5, 12, 0.8, 0.06},
                      {0.7, 12, -0.5, 0},
                      {0.9, 19, 0, -0.03},
                      {1.0, 19, 0, 0}},
                     Vec3(0.2, 0.1, 1)});
}

/// Lines taken anew: for what the needle has turned, how far it came back, where it is.
ForceScenario new_lines() {
  return prescribed("new-lines", plain_setup(),
                    {{{0, -1, 0, 0},
                      {0.3, 15, 0, 0},
                      {0.5, 9.9, 0, 0},     // back far enough
                      {1.0, 9.9, 0.5, 0},   // turns: the angle decides
                      {1.4, 11.2, 0.9, 0},  // turns on while it advances
                      {1.7, 13, 0.9, 0},
                      {1.8, 13, 1.6, 0},  // aside: how far it is drawn back decides
                      {2.3, 5.5, 0.9, 0},
                      {2.5, 5.5, 0.3, 0},  // near the skin the deviation decides
                      {2.7, 9, 0.3, 0},
                      {2.8, 2.5, 0, 0},
                      {2.9, 2.5, 0.4, 0},  // too near the skin
                      {3.3, 3.6, 0.4, 0},  // not as far in as that all is let go
                      {3.5, -1, 0.4, 0}},
                     Vec3::UnitZ()});
}

ForceScenario voigt_plasticity() {
  ForceSetup setup = plain_setup();
  setup.skin.prepuncture_law = PrepunctureLaw::simone_okamura;
  setup.skin.puncture_force = 0.05;
  setup.muscle.cutting_law = CuttingLaw::voigt;
  setup.fat.cutting_law = CuttingLaw::spring;
  setup.needle.clamping = ClampingLaw::plasticity;
  setup.needle.plasticity.yield_force = 0.1;
  setup.needle.use_workspace = true;
  setup.needle.workspace.centre = Vec3(0.02, 0.01, 0.158);
  Path displacement{{{0, -1, 0, 0},
                     {0.2, 2, 0, 0},
                     {0.4, 10, 1, 0},
                     {0.6, 17, -1, 0},
                     {0.7, 20, 0, 0},
                     {0.9, -1, 0, 0}},
                    Vec3::UnitZ()};
  return prescribed("voigt-plasticity", setup, displacement);
}

ForceScenario barbe_impulse() {
  ForceSetup setup = plain_setup();
  setup.skin.prepuncture_law = PrepunctureLaw::barbe;
  setup.skin.puncture_force = 0.05;
  setup.bursa.prepuncture_law = PrepunctureLaw::god_object;
  setup.needle.hard.law = HardLaw::impulse;
  Path displacement{{{0, -1, 0, 0}, {0.2, 2, 0, 0}, {0.5, 24.5, 0, 0}, {0.6, 24.5, 0, 0}},
                    Vec3::UnitZ()};
  displacement.rate_hz = 5000;
  return prescribed("barbe-impulse", setup, displacement);
}

/// A proxy on the skin under an oblique needle; the direct law throws the needle out, and the
/// passivity controller takes that energy back.
ForceScenario god_object_passivity() {
  ForceSetup setup = plain_setup();
  setup.skin.prepuncture_law = PrepunctureLaw::god_object;
  setup.muscle.cutting_law = CuttingLaw::direct;
  setup.passivity.control = true;
  setup.passivity.max_damping = 2;
  return prescribed("god-object-passivity", setup,
                    {{{0, 12, 0, 0},  // found inside
                      {0.3, 12, 0, 0},
                      {0.8, 3, 0, 0},
                      {1.0, -1, 0, 0},
                      {1.5, 6, 0, 0}},
                     Vec3(0.3, 0, 1)});
}

/// No membrane: friction and wall from the first tenth of a millimetre on.
ForceScenario slow_entry() {
  ForceSetup setup = plain_setup();
  setup.skin.puncture_force = 0;
  return prescribed(
      "slow-entry", setup,
      {{{0, -0.1, 0, 0}, {0.4, 0.3, 0, 0}, {0.6, 1.5, 0, 0}, {0.8, -0.1, 0, 0}}, Vec3::UnitZ()});
}

/// A popped membrane that lies askew, under a needle that sways ever wider.
ForceScenario swaying_over_a_membrane() {
  return prescribed("swaying", plain_setup(),
                    {{{0, -1, 0, 0},
                      {0.3, 18.5, 0, 0},
                      {0.4, 18.4, 0, 0},
                      {0.6, 18.4, 0.4, 0},
                      {0.9, 18.4, -0.8, 0},
                      {1.2, 18.4, 1.2, 0},
                      {1.5, 18.4, -2.4, 0},
                      {1.9, 18.4, 4, 0}},
                     Vec3(0.5, 0, 1)});
}

/// A membrane that has just popped: as its surface rises under a needle that sways, it is whole
/// anew.
ForceScenario at_the_edge_of_a_membrane() {
  return prescribed("membrane-edge", plain_setup(),
                    {{{0, -1, 0, 0},
                      {0.3, 16.6, 0, 0},
                      {0.4, 16.6, 0, 0},
                      {1.2, 16.6, 2.8, 0},
                      {2.8, 16.6, -2.8, 0}},
                     Vec3(0.5, 0, 1)});
}

/// Every layer has a membrane.
ForceScenario membranes() {
  ForceSetup setup = plain_setup();
  setup.muscle.puncture_force = 2.5;
  setup.fat.puncture_force = 1.8;
  return prescribed(
      "membranes", setup,
      {{{0, -1, 0, 0}, {0.4, 12, 0, 0}, {0.7, 20, 0, 0}, {0.9, 10, 0, 0}}, Vec3::UnitZ()});
}

/// Found inside, deeper than a line is looked for.
ForceScenario found_deep() {
  return prescribed("found-deep", plain_setup(),
                    {{{0, 70, 0, 0}, {0.2, 70, 0, 0}, {0.5, 72, 0.3, 0}}, Vec3::UnitZ()},
                    AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0}));
}

/// Poses that no hand makes, a clock that stands still, and what lies outside the workspace.
ForceScenario faults() {
  ForceSetup setup = plain_setup();
  setup.guard.workspace_centre = Vec3(0.01, 0.01, 0.005);
  setup.guard.workspace_half = Vec3(0.1, 0.1, 0.03);
  Path displacement{{{0, -10, 0, 0},
                     {0.1, -10, 0, 0},
                     {0.105, -10, 10.25, 0},  // 2.05 m/s
                     {0.2, -10, 10.25, 0},
                     {0.205, -10, 10.25, 0.205},  // 41 rad/s
                     {0.3, -10, 0, 0},
                     {0.4, -28, 0, 0},
                     {0.6, 8, 0, 0},
                     {1.1, 8, 0, 0},
                     {1.3, 9, 0, 0}},
                    Vec3::UnitZ()};
  displacement.frozen_from = 0.8;
  displacement.frozen_to = 0.83;
  return prescribed("faults", setup, displacement);
}

/// A weak device.
ForceScenario saturated() {
  ForceSetup setup = plain_setup();
  setup.device.force = 1.3;
  setup.device.torque = 0.004;
  return prescribed("saturated", setup,
                    {{{0, -1, 0, 0}, {0.3, 12, 0, 0}, {0.6, 13, 0.5, 0.1}}, Vec3::UnitZ()});
}

/// A strong device and laws that knock: the guard takes the edges off.
ForceScenario slewed() {
  ForceSetup setup = plain_setup();
  setup.device.force = 100;
  setup.device.torque = 10;
  setup.needle.hard.law = HardLaw::impulse;
  setup.needle.orientation.stiffness = 60;
  return prescribed("slewed", setup,
                    {{{0, -1, 0, 0},
                      {0.3, 12, 0, 0},
                      {0.301, 12, 0, 0.035},
                      {0.4, 12, 0, 0.035},
                      {0.5, 24.5, 0, 0},
                      {0.6, 24.5, 0, 0}},
                     Vec3::UnitZ()});
}

// ---- hand, device and operator in a closed loop

BodyExperiment body_experiment(const ForceSetup& setup) {
  BodyExperiment e;
  e.layers = layers_of(setup);
  e.names = {"skin", "muscle", "bursa", "fat", "bone"};
  e.body = flat_layers();
  e.needle = setup.needle;
  e.device = setup.device;
  e.feel.passivity_control = setup.passivity.control;
  return e;
}

ForceScenario closed_loop() {
  ForceSetup start = plain_setup();
  start.device.encoder_step = 13.7e-6;  // no layer and no goal lies on one of its steps
  return {"closed-loop", start, [](const ForceSetup& setup) {
            BodyExperiment e = body_experiment(setup);
            e.phases = {push_to(8 * kMm, 0.03),
                        stay(0.2),
                        let_go(0.2),
                        push_to(18 * kMm, 0.04),
                        aim(Vec3(0.05, 0, 1), 0.2),
                        pull_to(6 * kMm, 0.05)};
            return run_body(e);
          }};
}

/// The operator goes for the middle of a layer that is thicker than the query looks ahead.
ForceScenario into_a_thick_layer() {
  return {"thick-layer", plain_setup(), [](const ForceSetup& setup) {
            BodyExperiment e = body_experiment(setup);
            e.body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, 2.0371 * kMm});
            OperatorPhase phase = push_to(0, 0.04);
            phase.goal = OperatorPhase::Goal::region;
            phase.region = kFirstRegion + 1;
            phase.depth = 30 * kMm;
            phase.duration = 2;
            e.phases = {phase, stay(0.1)};
            return run_body(e);
          }};
}

/// A tip pressed against the side of a round bone that then slides off it: the line loses the bone
/// at once, the bevel does not.
ForceScenario off_steep_bone() {
  ForceSetup setup = plain_setup();
  setup.bone.cutting_force = 8;
  setup.bone.wall_stiffness = 800;
  return {"steep-bone", setup, [](const ForceSetup& s) {
            constexpr double kBeside = 14.9;  // mm, of the bone's 15
            BodyExperiment e = body_experiment(s);
            e.layers = {layer_of(s.skin), layer_of(s.bone)};
            e.names = {"skin", "bone"};
            e.body = AnalyticBody::make_balls(Vec3(0, 0, 30 * kMm), {30 * kMm, 15 * kMm});
            e.entry = Vec3(kBeside, 0, 30 - std::sqrt(900 - kBeside * kBeside)) * kMm;
            e.path = [entry = e.entry](double t) {
              Intention want;
              const double depth = std::min(0.04 * t, 34 * kMm) - 5 * kMm;
              const double aside = std::clamp(4e-3 * (t - 1.2), 0.0, 2 * kMm);
              want.X_JN = make_pose(entry + Vec3(aside, 0, depth), Vec3::UnitZ(), Vec3::UnitX());
              return want;
            };
            e.path_duration = 1.8;
            return run_body(e);
          }};
}

}  // namespace

std::vector<ForceScenario> make_force_scenarios() {
  return {tracking_wall(),
          bent_aside(),
          new_lines(),
          voigt_plasticity(),
          barbe_impulse(),
          god_object_passivity(),
          slow_entry(),
          swaying_over_a_membrane(),
          at_the_edge_of_a_membrane(),
          membranes(),
          found_deep(),
          faults(),
          saturated(),
          slewed(),
          closed_loop(),
          into_a_thick_layer(),
          off_steep_bone()};
}

std::vector<std::string> scenario_region_names() {
  return region_names({"skin", "muscle", "bursa", "fat", "bone"});
}

}  // namespace artus::test
