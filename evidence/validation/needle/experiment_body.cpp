// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/needle/experiment_body.h"

#include "artus/detail/haptics/needle/needle_tick_step.h"

namespace artus {

std::vector<NeedleRow> run_body(const BodyExperiment& e) {
  std::vector<NeedleRow> rows;
  run_body(e, [&rows](const NeedleRow& row) { rows.push_back(row); });
  return rows;
}

void run_body(const BodyExperiment& e, const std::function<void(const NeedleRow&)>& take_row) {
  std::vector<LayerHaptics> by_region(kFirstRegion);
  std::vector<LayerHaptics> layers = e.layers;
  const auto names = e.names.empty() ? numbered_layers(layers.size()) : e.names;
  for (std::size_t i = 0; i < layers.size() && i < names.size(); ++i)
    apply(e.feel, names[i], layers[i]);
  by_region.insert(by_region.end(), layers.begin(), layers.end());
  InjectionOperator person(e.entry, e.direction, -e.start_outside, e.phases);
  HandLoop loop({e.rate_hz, 20000}, e.device, e.hand, person.start());
  NeedleRendererParams params;
  params.needle = e.needle;
  params.device = e.device;
  params.rate_hz = e.rate_hz;
  apply(e.feel, params.needle);
  apply(e.feel, params.passivity);
  NeedleTickStep tick(LayerTable(std::move(by_region)), params);
  tick.take({{}, e.tissue});
  const auto intend = [&e, &person](double at) {
    return e.path ? e.path(at) : person.intention(at);
  };
  const auto done = [&e, &person, &loop] {
    return e.path ? loop.time() >= e.path_duration : person.done();
  };
  while (!done()) {
    const double t = loop.time();
    const Pose measured = loop.measured();
    const RenderedNeedle& rendered = tick.step({measured, t}, e.body);
    NeedleRow row = make_needle_row(t, measured, rendered, tick.model());
    row.energy_to_hand = loop.energy_to_hand();
    row.hand = loop.hand_force();
    row.needle = loop.motion();
    take_row(row);
    if (!e.path) person.observe(t, measured, view_of(tick.model()));
    loop.advance(rendered.command, intend);
  }
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
