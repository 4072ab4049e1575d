// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/needle/experiment_body.h"

#include <array>

#include "artus/haptics/passivity.h"

namespace artus {

std::vector<NeedleRow> run_body(const BodyExperiment& e) {
  std::vector<LayerHaptics> by_region(kFirstRegion);
  std::vector<LayerHaptics> layers = e.layers;
  const auto names = e.names.empty() ? numbered_layers(layers.size()) : e.names;
  for (std::size_t i = 0; i < layers.size() && i < names.size(); ++i)
    apply(e.feel, names[i], layers[i]);
  by_region.insert(by_region.end(), layers.begin(), layers.end());
  const LayerTable table(std::move(by_region));
  const Pose start =
      make_pose(e.entry - e.start_outside * e.direction, e.direction, e.direction.unitOrthogonal());
  HandLoop loop({e.rate_hz, 20000}, e.device, e.hand, start);
  NeedleParams needle = e.needle;
  apply(e.feel, needle);
  NeedleModel model(needle, table, loop.period());
  PassivityObserver passivity({.control = e.feel.passivity_control}, loop.period());
  const GuardParams limits;
  InputGuard input(limits, loop.period());
  OutputGuard output(limits, e.device, loop.period());
  InjectionOperator person(e.entry, e.direction, -e.start_outside, e.phases);
  std::array<TissueInterval, 64> buffer{};
  std::vector<NeedleRow> rows;
  const auto intend = [&e, &person](double at) {
    return e.path ? e.path(at) : person.intention(at);
  };
  const auto done = [&e, &person, &loop] {
    return e.path ? loop.time() >= e.path_duration : person.done();
  };
  while (!done()) {
    const double t = loop.time();
    const Pose measured = loop.measured();
    RenderedNeedle rendered;
    const std::uint32_t faults = input.check({measured, t});
    if (faults == 0) {
      rendered.forces =
          model.step(measured, e.body.find_intervals(model.query_segment(measured), buffer));
    } else {
      model.reset();
      passivity.pause();
    }
    Wrench wanted = rendered.forces.total;
    if (faults == 0) wanted.force = passivity.step(measured.translation(), wanted.force);
    rendered.command = output.apply(wanted, faults, rendered.status);
    passivity.observe(rendered.command.force);
    rows.push_back(make_needle_row(t, measured, rendered, model));
    rows.back().energy_to_hand = loop.energy_to_hand();
    rows.back().hand = loop.hand_force();
    rows.back().needle = loop.motion();
    if (!e.path) person.observe(t, measured, model);
    loop.advance(rendered.command, intend);
  }
  return rows;
}

LayerHaptics plain_layer(double cutting, double stiffness, double attracted) {
  LayerHaptics layer;
  layer.tissue.cutting_force = cutting;
  layer.tissue.wall_stiffness = stiffness;
  layer.tissue.attracted_force = attracted;
  return layer;
}

LayerHaptics bone_layer(double cutting, double stiffness) {
  LayerHaptics layer = plain_layer(cutting, stiffness);
  layer.tissue.hard = true;
  return layer;
}

OperatorPhase push_to(double depth, double speed) {
  OperatorPhase phase;
  phase.kind = OperatorPhase::Kind::advance;
  phase.depth = depth;
  phase.speed = speed;
  phase.duration = 60;
  return phase;
}

OperatorPhase pull_to(double depth, double speed) {
  OperatorPhase phase = push_to(depth, speed);
  phase.kind = OperatorPhase::Kind::withdraw;
  return phase;
}

OperatorPhase stay(double duration) {
  OperatorPhase phase;
  phase.kind = OperatorPhase::Kind::hold;
  phase.duration = duration;
  return phase;
}

OperatorPhase let_go(double duration) {
  OperatorPhase phase = stay(duration);
  phase.kind = OperatorPhase::Kind::let_go;
  return phase;
}

OperatorPhase aim(const Vec3& direction, double duration) {
  OperatorPhase phase = stay(duration);
  phase.kind = OperatorPhase::Kind::turn;
  phase.direction = direction.normalized();
  return phase;
}

std::vector<std::string> numbered_layers(std::size_t layers) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= layers; ++i) names.push_back("layer " + std::to_string(i));
  return names;
}

std::vector<std::string> region_names(std::vector<std::string> layers) {
  layers.insert(layers.begin(), {"outside", "beyond"});
  return layers;
}

std::vector<std::string> layer_names(std::size_t layers) {
  return region_names(numbered_layers(layers));
}

}  // namespace artus
