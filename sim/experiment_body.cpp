// SPDX-License-Identifier: AGPL-3.0-or-later
#include "sim/experiment_body.h"

#include <array>

namespace artus {

std::vector<NeedleRow> run_body(const BodyExperiment& e) {
  std::vector<LayerHaptics> by_region(kFirstRegion);
  by_region.insert(by_region.end(), e.layers.begin(), e.layers.end());
  const LayerTable table(std::move(by_region));
  const Pose start =
      make_pose(e.entry - e.start_outside * e.direction, e.direction, e.direction.unitOrthogonal());
  NeedleLoop loop({e.rate_hz, 20000}, e.device, e.hand, start);
  NeedleModel model(e.needle, table, loop.period());
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
    }
    rendered.command = output.apply(rendered.forces.total, faults, rendered.status);
    rows.push_back(make_needle_row(t, measured, rendered, model));
    rows.back().energy_to_hand = loop.energy_to_hand();
    rows.back().hand = loop.hand_force();
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

std::vector<std::string> layer_names(std::size_t layers) {
  std::vector<std::string> names{"outside", "beyond"};
  for (std::size_t i = 1; i <= layers; ++i) names.push_back("layer " + std::to_string(i));
  return names;
}

}  // namespace artus
