// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/apps/press_options.h"

#include "artus/apps/command.h"
#include "artus/apps/needle_drag.h"
#include "artus/core/units.h"
#include "artus/raycast/moving_scene.h"

namespace artus {
namespace {

constexpr double kDefaultPress = 3;  // N

/// Loads the body with what the needle puts on it, and lets it come to rest under the held probe.
nlohmann::json drag(SoftBody& body, const LoadedView& view, PressedBody& pressed,
                    const std::string& way) {
  const auto loads = sliding_loads(*make_scene(pressed.tissue), *view.needle,
                                   way == "in" ? NeedleWay::in : NeedleWay::out);
  const Pose X_CJ = body.cage_pose().inverse();
  std::vector<PointLoad> in_cage;
  double sum = 0;
  for (const PointLoad& load : loads) {
    in_cage.push_back(
        {X_CJ * pressed.tissue->to_rest(load.p_rest).p_rest, X_CJ.linear() * load.force});
    sum += load.force.dot(view.needle->X_JN.linear().col(2));
  }
  body.solver().set_loads(std::move(in_cage));
  const bool settled = body.settle(pressed.press.X_JP, 2e-6, 60);
  const auto before = pressed.tissue;
  pressed.tissue = body.snapshot();
  const Vec3 tip = before->to_rest(view.needle->X_JN.translation()).p_rest;
  const Vec3 moved = pressed.tissue->displacement(tip) - before->displacement(tip);
  return {{"way", way},
          {"force_n", sum},
          {"tissue_moved_mm", moved.dot(view.needle->X_JN.linear().col(2)) / kMillimetre},
          {"settled", settled}};
}

}  // namespace

void add_drag_option(Command* command, PressOptions& options) {
  command
      ->add_option("--needle-way", options.needle_way,
                   "the needle was last moved in or out, and drags what it slides through; needs "
                   "--press-n or --press-mm")
      ->one_of({"in", "out"});
}

void add_press_options(Command* command, PressOptions& options) {
  command
      ->add_option("--press-n", options.newtons,
                   "the tissue gives way to a probe on which the hand holds so much, N")
      ->check(number_in(0.01, 30));
  command
      ->add_option("--press-mm", options.millimetres,
                   "the same for a probe that goes in so far from its pose, mm")
      ->check(number_in(0, 25));
}

Result<PressedBody> press(SoftBody& body, const Pose& X_JP, const PressOptions& options) {
  if (options.newtons && options.millimetres)
    return fail(ErrorCode::malformed, "give a force or a depth, not both", "--press-mm");
  const auto pressed = options.millimetres
                           ? Result<Press>(press_by(body, X_JP, *options.millimetres * kMillimetre))
                           : press_with(body, X_JP, options.newtons.value_or(kDefaultPress));
  ARTUS_TRY(pressed);
  return PressedBody{*pressed, body.snapshot()};
}

Result<nlohmann::json> press(LoadedView& view, const PressOptions& options) {
  if (!options.needle_way.empty() && !(options.wanted() && view.needle))
    return fail(ErrorCode::malformed, "needs a pressed probe (--press-n) and a needle (--needle)",
                "--needle-way");
  if (!options.wanted()) return nlohmann::json();
  auto body = SoftBody::make(view.scene->shared_joint(), view.X_JP);
  ARTUS_TRY(body);
  auto pressed = press(*body, view.X_JP, options);
  ARTUS_TRY(pressed);
  auto report = to_json(pressed->press);
  if (view.needle && !options.needle_way.empty())
    report["needle"] = drag(*body, view, *pressed, options.needle_way);
  view.scene = make_scene(pressed->tissue);
  view.X_JP = pressed->press.X_JP;
  return report;
}

nlohmann::json to_json(const Press& press) {
  const auto three = [](const Vec3& f) {
    return nlohmann::json{f.x(), f.y(), f.z()};
  };
  return {{"depth_mm", press.depth / kMillimetre},
          {"normal_force_n", press.normal_force},
          {"force_n", three(press.contact.force)},
          {"torque_n_mm", three(press.contact.torque / kMillimetre)},
          {"contact_share", press.contact.share},
          {"settled", press.settled}};
}

}  // namespace artus
