// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/press_options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/probe/pressing_face.h"
#include "artus/detail/raycast/moving_scene.h"
#include "artus/detail/simulation/needle_drag.h"

namespace artus {
namespace {

constexpr double kDefaultPress = 3;  // N

constexpr double kPart = 1e-3;  // m by which tissue is pushed on at a time

/// The material point that is now at `p`, as a term of length one along the needle, frame C.
PointLoad along_needle(const PressedBody& pressed, const Pose& X_CJ, const Vec3& p,
                       const Vec3& axis) {
  return {X_CJ * pressed.tissue->to_rest(p).p_rest, X_CJ.linear() * axis};
}

/// Pushes the tissue before the tip on until what is to lie there does, part by part.
bool push_on(SoftBody& body, const Pose& X_JP, const PointLoad& term, double push) {
  SoftSolver& solver = body.solver();
  solver.set_constraints({{{term}, 0}});
  const double from = solver.constraint_sum(0);
  for (double distance = kPart; distance < push; distance += kPart) {
    solver.set_constraint_value(0, from + distance);
    body.settle(X_JP, 5e-5, 4);
  }
  solver.set_constraint_value(0, from + push);
  return body.settle(X_JP, 2e-6, 60);
}

}  // namespace

void add_drag_option(Command* command, PressOptions& options) {
  command
      ->add_option("--needle-way", options.needle_direction,
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

Result<ProbeFace> pressing_face_at(const Transducer& transducer, const std::string& flag) {
  auto face = pressing_face(transducer);
  if (!face) face.error().where = flag;
  return face;
}

Result<SoftBody> make_soft_body(std::shared_ptr<const CompiledJoint> joint, const Pose& X_JP,
                                const Transducer& transducer) {
  SoftBodyParams params;
  const auto face = pressing_face_at(transducer, "--transducer");
  ARTUS_TRY(face);
  params.face = *face;
  return SoftBody::make(std::move(joint), X_JP, params);
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

Result<nlohmann::json> drag(SoftBody& body, const std::optional<NeedleView>& needle,
                            const std::string& distance, PressedBody& pressed) {
  if (!needle) return nlohmann::json();
  const bool out = distance == "out";
  const Pose X_CJ = body.cage_pose().inverse();
  const Vec3 axis = needle->X_JN.linear().col(2);
  const Vec3 tip = needle->X_JN.translation();
  SoftSolver& solver = body.solver();
  const auto scene = make_scene(pressed.tissue);
  solver.set_constraints({{{along_needle(pressed, X_CJ, tip, axis)}, 0}});
  const double compliance = solver.constraint_compliance()(0, 0);
  solver.set_constraints({});
  const NeedleDrag held =
      find_drag(*scene, *needle, out ? NeedleDirection::out : NeedleDirection::in, compliance);
  std::vector<PointLoad> in_cage;
  double sum = held.tip_force;
  for (const PointLoad& load : held.shaft) {
    in_cage.push_back(along_needle(pressed, X_CJ, load.p_rest, load.force));
    sum += load.force.dot(axis);
  }
  solver.set_loads(std::move(in_cage));
  const Pose& X_JP = pressed.press.X_JP;
  bool settled = body.settle(X_JP, held.push > 0 ? 5e-5 : 2e-6, 60);
  if (held.push > 0)
    settled =
        push_on(body, X_JP, along_needle(pressed, X_CJ, tip - held.push * axis, axis), held.push);
  if (!settled)
    return fail(ErrorCode::failed, "the tissue does not come to rest under this needle",
                "--needle-way");
  const auto before = pressed.tissue;
  pressed.tissue = body.snapshot();
  pressed.press.contact = body.force_J();
  pressed.press.normal_force = -pressed.press.contact.force.dot(X_JP.linear().col(2));
  const Vec3 at_tip = before->to_rest(tip - held.push * axis).p_rest;
  const Vec3 moved = pressed.tissue->displacement(at_tip) - before->displacement(at_tip);
  nlohmann::json report{{"way", out ? "out" : "in"},
                        {"force_n", sum},
                        {"tip_force_n", held.tip_force},
                        {"tissue_moved_mm", moved.dot(axis) / kMillimetre},
                        {"least_volume_ratio", solver.forces().min_volume}};
  if (held.tented != kOutside) report["tented"] = body.joint()->regions[held.tented].name;
  return report;
}

Result<nlohmann::json> press(LoadedView& view, const PressOptions& options) {
  if (!options.needle_direction.empty() && !(options.wanted() && view.needle))
    return fail(ErrorCode::malformed, "needs a pressed probe (--press-n) and a needle (--needle)",
                "--needle-way");
  if (!options.wanted()) return nlohmann::json();
  auto body = make_soft_body(view.scene->shared_joint(), view.X_JP, view.view.transducer);
  ARTUS_TRY(body);
  auto pressed = press(*body, view.X_JP, options);
  ARTUS_TRY(pressed);
  auto report = to_json(pressed->press);
  if (view.needle && !options.needle_direction.empty()) {
    auto needle = drag(*body, view.needle, options.needle_direction, *pressed);
    ARTUS_TRY(needle);
    report["needle"] = std::move(*needle);
  }
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

void print_press(const nlohmann::json& press) {
  if (press.is_null()) return;
  std::printf("pressed %.2f mm, %.3f N, %.0f %% of the face%s\n", press["depth_mm"].get<double>(),
              press["normal_force_n"].get<double>(), 100 * press["contact_share"].get<double>(),
              press["settled"].get<bool>() ? "" : ", still moving");
}

}  // namespace artus
