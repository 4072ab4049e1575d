// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "artus/anatomy/body/meshed_block.h"
#include "artus/core/units.h"
#include "artus/echo/renderer.h"
#include "artus/evidence/soft/soft_gates_list.h"
#include "artus/raycast/layers_below.h"
#include "artus/raycast/pressed_scene.h"
#include "artus/session/tissue_core.h"

namespace artus {
namespace {

constexpr double kStillRate = 30;       // images a second
constexpr int kStillPressing = 30;      // images, 1 s
constexpr int kStillImages = 60;        // 2 s in which the tissue comes to rest
constexpr int kStillCompared = 30;      // images, 1 s
constexpr double kPressedWith = 3;      // N
constexpr double kMiddleOfBand = 5e-3;  // m
constexpr double kHalfOfBand = 3e-3;    // m

Result<PressedScene> press_with_3_newtons(const std::shared_ptr<const CompiledJoint>& joint) {
  PressGoal goal;
  goal.force = kPressedWith;
  return press_scene(joint, joint->X_JP_default, goal);
}

/// I7 on any body, as a session steps it. Every picture is of one probe pose, so that what differs
/// is the tissue's alone.
std::vector<Claim> claims_of_still_probe(const std::shared_ptr<const CompiledJoint>& joint) {
  const auto pressed = press_with_3_newtons(joint);
  auto core = TissueCore::make(joint, joint->X_JP_default, kStillRate);
  if (!pressed || !core)
    return {claim_that(
        ClaimKind::input,
        "I7: a body that gives way: " + (pressed ? core.error() : pressed.error()).to_string(),
        false)};
  const Pose& X_JP = pressed->press.X_JP;
  const auto look = [&] {
    return render_bmode(core->scene(), X_JP, std::nullopt, {}, {});
  };
  const auto is_same = [](const Frame& a, const Frame& b) {
    return a.in_phase == b.in_phase && a.quadrature == b.quadrature && a.image == b.image;
  };
  const Frame before = look();
  for (int i = kStillPressing - 1; i >= 0; --i) {
    Pose on_the_way = X_JP;
    on_the_way.translation() -= pressed->press.depth * i / kStillPressing * X_JP.linear().col(2);
    core->step(on_the_way);
  }
  for (int i = 0; i < kStillImages; ++i) core->step(X_JP);
  const Frame at_rest = look();
  const auto felt = core->packet().probe.wrench;
  int pictures = 0;
  int forces = 0;
  for (int i = 0; i < kStillCompared; ++i) {
    core->step(X_JP);
    pictures += is_same(at_rest, look()) ? 0 : 1;
    forces += core->packet().probe.wrench == felt ? 0 : 1;
  }
  const ClaimBasis kept{ClaimKind::input, "a state in which nothing moves is kept"};
  return {claim_that({ClaimKind::input, "so much was pressed"},
                     "I7: the press has changed the picture", !is_same(before, at_rest)),
          claim_at_most(kept, "I7: pictures that differ, 2 to 3 s after 3 N were pressed in 1 s",
                        pictures, 0, ""),
          claim_at_most(kept, "I7: the hand's forces that differ then", forces, 0, "")};
}

/// Share by which the uppermost layer of a tissue thins; nothing: none on the axis.
std::optional<double> thinned(const std::vector<LayerBelow>& layers, const CompiledJoint& joint,
                              std::string_view tissue) {
  const auto at = std::find_if(layers.begin(), layers.end(), [&](const LayerBelow& layer) {
    return joint.tissue_of(layer.region).name == tissue;
  });
  if (at == layers.end()) return std::nullopt;
  return at->thinned();
}

}  // namespace

Gate gate_still() {
  Gate gate;
  gate.title = "a probe held still on skin, fat and muscle over bone (I7)";
  const auto tissues = read_bundled_tissues();
  if (!tissues) return gate;
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  gate.claims = claims_of_still_probe(std::make_shared<const CompiledJoint>(
      make_meshed_block(*tissues, layers, 64e-3, 48e-3, 4e-3)));
  return gate;
}

Gate gate_joint_still(const std::shared_ptr<const CompiledJoint>& joint) {
  Gate gate;
  gate.title = "a probe held still on " + joint->name + " (I7)";
  gate.claims = claims_of_still_probe(joint);
  return gate;
}

Gate gate_joint_pressed(const std::shared_ptr<const CompiledJoint>& joint) {
  Gate gate;
  gate.title = joint->name + " under 3 N at its default probe (H2)";
  const auto pressed = press_with_3_newtons(joint);
  if (!pressed) {
    gate.claims = {claim_that(ClaimKind::independent, "H2: " + pressed.error().to_string(), false)};
    return gate;
  }
  gate.claims.push_back(claim_at_rest("H2: the pressed joint", pressed->press.settled));
  const ClaimBasis fitted{ClaimKind::fitted,
                          "skin's values were chosen with it in view; the band is assumed"};
  gate.claims.push_back(claim_within(fitted, "H2: 3 N press it by, a shoulder's band",
                                     pressed->press.depth / kMillimetre,
                                     kMiddleOfBand / kMillimetre, kHalfOfBand / kMillimetre, "mm"));
  const auto layers = layers_below(*pressed->scene->tissue(), joint->X_JP_default);
  const auto fat = thinned(layers, *joint, "fat");
  const auto muscle = thinned(layers, *joint, "muscle");
  const auto tendon = thinned(layers, *joint, "tendon");
  if (fat && muscle)
    gate.claims.push_back(claim_that(fitted, "H2: fat thins more than muscle", *fat > *muscle));
  if (fat && tendon)
    gate.claims.push_back(claim_that({ClaimKind::input, "fat is given the lowest stiffness"},
                                     "H2: fat thins more than tendon", *fat > *tendon));
  if (muscle && tendon)
    gate.claims.push_back(claim_that({ClaimKind::input, "tendon is given the higher stiffness"},
                                     "H2: muscle thins more than tendon", *muscle > *tendon));
  return gate;
}

}  // namespace artus
