// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/press_options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/probe/pressing_face.h"
#include "artus/detail/raycast/moving_scene.h"
#include "artus/detail/simulation/still.h"

namespace artus {
namespace {

constexpr double kDefaultPress = 3;  // N

}  // namespace

void add_drag_option(Command* command, PressOptions& options) {
  command
      ->add_option("--needle-direction,--needle-way", options.needle_direction,
                   "direction in which the needle was last moved: it drags the tissue along; needs "
                   "--press-n or --press-mm")
      ->one_of({"in", "out"});
}

void add_press_options(Command* command, PressOptions& options) {
  command
      ->add_option("--press-n", options.newtons,
                   "force with which the hand presses the probe, N; the tissue gives way to it")
      ->check(number_in(0.01, 30));
  command
      ->add_option("--press-mm", options.millimetres,
                   "in place of a force: how far the probe goes in from its pose, mm")
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

Result<nlohmann::json> drag(const std::shared_ptr<const CompiledJoint>& joint,
                            const Transducer& transducer, const NeedleView& needle,
                            const std::string& direction, PressedBody& pressed) {
  const bool out = direction == "out";
  const auto still = lead_to(joint, pressed.press, transducer, needle,
                             out ? NeedleDirection::out : NeedleDirection::in);
  ARTUS_TRY(still);
  pressed.tissue = still->scene->tissue();
  pressed.press.normal_force = still->probe_force;
  pressed.press.contact.share = still->share;
  const auto name = [&joint](RegionId region) {
    return joint->regions[region].name;
  };
  nlohmann::json report{{"direction", out ? "out" : "in"},
                        {"force_n", still->needle.force},
                        {"tip_force_n", still->needle.tip_force},
                        {"tissue_moved_mm", still->needle.tissue_moved / kMillimetre},
                        {"region", name(still->needle.region)}};
  if (still->needle.tented != kOutside) report["tented"] = name(still->needle.tented);
  return report;
}

Result<nlohmann::json> press(LoadedView& view, const PressOptions& options) {
  if (!options.needle_direction.empty() && !(options.wanted() && view.needle))
    return fail(ErrorCode::malformed, "needs a pressed probe (--press-n) and a needle (--needle)",
                "--needle-direction");
  if (!options.wanted()) return nlohmann::json();
  auto body = make_soft_body(view.scene->shared_joint(), view.X_JP, view.view.transducer);
  ARTUS_TRY(body);
  auto pressed = press(*body, view.X_JP, options);
  ARTUS_TRY(pressed);
  auto report = to_json(pressed->press);
  if (view.needle && !options.needle_direction.empty()) {
    auto needle = drag(view.scene->shared_joint(), view.view.transducer, *view.needle,
                       options.needle_direction, *pressed);
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
          {"short_of_mm", press.short_of / kMillimetre},
          {"settled", press.settled}};
}

void print_press(const nlohmann::json& press) {
  if (press.is_null()) return;
  std::printf("pressed %.2f mm, %.3f N, %.0f %% of the face%s\n", press["depth_mm"].get<double>(),
              press["normal_force_n"].get<double>(), 100 * press["contact_share"].get<double>(),
              press["settled"].get<bool>() ? "" : ", still moving");
  if (const double left = press["short_of_mm"]; left > 0)
    std::printf("%.2f mm less than asked for: a face presses with %.0f N at most\n", left,
                SoftSolverParams{}.most_force);
}

}  // namespace artus
