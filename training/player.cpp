// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/player.h"

#include <algorithm>
#include <utility>

#include "artus/detail/anatomy/body/meshed_block.h"
#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/echo/probe/pressing_face.h"
#include "artus/detail/training/session_meter.h"
#include "artus/detail/training/simulated_attempt.h"
#include "artus/echo/transducer_file.h"

namespace artus {
namespace {

constexpr double kGuide = 300;  // N/m of a whole haptic_guide; assumed
constexpr double kWall = 1000;  // N/m of a whole haptic_wall; assumed

Result<RegionId> find_region(const CompiledJoint& joint, const std::string& name) {
  for (std::size_t i = kFirstRegion; i < joint.regions.size(); ++i)
    if (joint.regions[i].name == name) return static_cast<RegionId>(i);
  return fail(ErrorCode::not_found, "the joint has no structure '" + name + "'", joint.name);
}

}  // namespace

Result<std::shared_ptr<const Scene>> make_gel_scene(const GelBlock& gel) {
  const auto tissues = read_bundled_tissues();
  ARTUS_TRY(tissues);
  std::vector<std::string> names;
  for (const FlatLayer& layer : gel.layers) names.push_back(layer.tissue);
  for (const Ball& ball : gel.balls) names.push_back(ball.tissue);
  for (const std::string& name : names) {
    const bool known = std::any_of(tissues->begin(), tissues->end(),
                                   [&](const Tissue& t) { return t.name == name; });
    if (!known) return fail(ErrorCode::not_found, "there is no tissue '" + name + "'", "gel");
  }
  constexpr double kCell = 2.5e-3;  // m, of the block's tetrahedra; the cage's cubes are 3 mm
  CompiledJoint block = make_meshed_block(*tissues, gel.layers, gel.width, gel.width, kCell);
  stand_on_table(block);
  for (const Ball& ball : gel.balls)
    add_meshed_ball(block, ball, static_cast<RegionId>(kFirstRegion + layer_of(gel, ball)));
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(block)));
}

HandAids aids_of(const Scenario& scenario) {
  HandAids aids;
  aids.entry = scenario.entry.centre;
  aids.target = scenario.target.point;
  for (const Aid& aid : scenario.aids) {
    if (aid.name == "haptic_guide") aids.guide = kGuide * aid.value;
    if (aid.name == "haptic_wall") aids.wall = kWall * aid.value;
  }
  for (const ScenarioAvoid& avoid : scenario.avoid)
    aids.keep_out += (aids.keep_out.empty() ? "" : "\n") + avoid.structure;
  return aids;
}

Result<SessionParams> make_session_params(const Scenario& scenario) {
  SessionParams params;
  const auto device = find_device("virtuose_6d_desktop");
  ARTUS_TRY(device);
  params.device = *device;
  const auto transducer = find_transducer(scenario.transducer);
  ARTUS_TRY(transducer);
  params.transducer = transducer->transducer;
  params.image.depth = scenario.depth;
  params.image.seed = scenario.seed;
  params.needle_shape = needle_of_gauge(scenario.gauge).value_or(NeedleShape{});
  params.feel.needle_length = scenario.needle_length;
  params.syringe = syringe_of(scenario);
  params.aids = aids_of(scenario);
  ARTUS_TRY(validate(params));
  return params;
}

Result<MeterOptions> make_meter_options(const Scenario& scenario, const CompiledJoint& joint,
                                        const SessionParams& params) {
  MeterOptions options;
  options.transducer = params.transducer;
  options.image_depth = params.image.depth;
  options.needle = params.needle_shape;
  options.look = params.image.look;
  options.longest = 2 * scenario.time_limit + 60;
  if (!scenario.find.empty()) {
    for (const std::string& name : scenario.find) ARTUS_TRY(find_region(joint, name));
    options.goals.sought = scenario.find;
    return options;
  }
  Target target{scenario.target.structure, std::nullopt, nullptr};
  if (scenario.target.structure.empty()) {
    target = {"the target", scenario.target.point, nullptr};
  } else {
    const auto region = find_region(joint, scenario.target.structure);
    ARTUS_TRY(region);
    target.body = make_region_body(joint, *region);
  }
  options.goals.target = target;
  options.goals.entry = scenario.entry.centre;
  for (const ScenarioAvoid& avoid : scenario.avoid) {
    const auto region = find_region(joint, avoid.structure);
    ARTUS_TRY(region);
    options.goals.avoid.push_back(
        {avoid.structure, make_region_body(joint, *region), avoid.margin, avoid.fatal});
  }
  return options;
}

PreparedBody make_played_body(const Scenario& scenario, const Scene& scene) {
  const auto transducer = find_transducer(scenario.transducer);
  if (!transducer || !gives_way(scene.joint())) return {};
  const auto face = pressing_face(transducer->transducer);
  if (!face) return {};
  SoftBodyParams params;
  params.face = *face;
  auto body = SoftBody::make(scene.shared_joint(), scenario.X_JP, params);
  if (!body) return {};
  return {std::make_shared<const SoftBody>(std::move(*body)),
          std::make_shared<const OpenedSpaces>(scene.shared_joint(), scenario.syringe.volume > 0)};
}

void add_asked(const Scenario& scenario, const std::set<std::string>& asked,
               std::vector<Metric>& metrics) {
  double questions = 0;
  double put = 0;
  for (const std::string& step : scenario.steps) {
    if (step.rfind("ask:", 0) != 0) continue;
    ++questions;
    put += asked.count(step) != 0 ? 1 : 0;
  }
  if (questions == 0) return;
  metrics.push_back({"asked",
                     "patient",
                     "-",
                     put / questions,
                     "share of the task's questions to the patient that were asked before it began",
                     {"none, once", 0}});
}

Result<PlayedAttempt> play(const Scenario& with_aids, const std::shared_ptr<const Scene>& scene,
                           const OperatorSkill& skill, const PlayOptions& options) {
  Scenario scenario = with_aids;
  scenario.aids.clear();
  auto params = make_session_params(scenario);
  ARTUS_TRY(params);
  params->deform = !options.rigid && gives_way(scene->joint());
  params->X_JC = scenario.X_JP;
  // A probe that looks for something crosses one cage after the other, and would wait for each.
  params->wait_for_cage = scenario.find.empty();
  params->image_rate = std::max(options.tissue_rate, options.picture_rate);
  auto meter_options = make_meter_options(scenario, scene->joint(), *params);
  ARTUS_TRY(meter_options);
  PlayedAttempt attempt;
  AttemptMeter meter(scene, std::move(*meter_options));
  const double longest = scenario.time_limit + 30;
  const auto hands =
      make_simulated_attempt(scenario, scene, *params, skill, options, attempt.recording);
  while (hands->time() < longest && hands->step(meter)) {
  }
  attempt.duration = hands->time();
  attempt.body = hands->find_body();
  if (attempt.body) attempt.health = measure_body_health(*attempt.body);
  attempt.measures = meter.measure();
  add_asked(scenario, {scenario.steps.begin(), scenario.steps.end()}, attempt.measures.metrics);
  attempt.judgement =
      judge(attempt.measures.metrics, scenario.pass, scenario.score, scenario.aided());
  return attempt;
}

}  // namespace artus
