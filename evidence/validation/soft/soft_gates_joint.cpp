// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "artus/detail/anatomy/body/meshed_block.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/soft/soft_gates.h"
#include "artus/detail/raycast/layers_below.h"
#include "artus/detail/raycast/pressed_scene.h"
#include "artus/detail/simulation/tissue_core.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

constexpr double kStillRate = 30;       // images a second
constexpr int kStillPressing = 30;      // images, 1 s
constexpr int kStillMax = 150;          // images, 5 s in which the tissue may come to rest
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
    Pose on_the_path = X_JP;
    on_the_path.translation() -= pressed->press.depth * i / kStillPressing * X_JP.linear().col(2);
    core->step(on_the_path);
  }
  int moving = 0;
  for (std::shared_ptr<const DeformedBody> last; moving < kStillMax; ++moving) {
    last = core->tissue();
    core->step(X_JP);
    if (core->tissue() == last) break;
  }
  const Frame at_rest = look();
  const double felt = force_at_rest(core->packet().probe, X_JP).force;
  int pictures = 0;
  int forces = 0;
  for (int i = 0; i < kStillCompared; ++i) {
    core->step(X_JP);
    pictures += is_same(at_rest, look()) ? 0 : 1;
    forces += force_at_rest(core->packet().probe, X_JP).force == felt ? 0 : 1;
  }
  const ClaimBasis kept{ClaimKind::input, "a state in which nothing moves is kept"};
  return {claim_that({ClaimKind::input, "so much was pressed"},
                     "I7: the press has changed the picture", !is_same(before, at_rest)),
          claim_at_most({ClaimKind::fitted, "the relaxation time was chosen with rest in view"},
                        "I7: pressed by 3 N in 1 s and held, at rest after", moving / kStillRate, 4,
                        "s"),
          claim_at_most(kept, "I7: pictures of the next second that differ", pictures, 0, ""),
          claim_at_most(kept, "I7: the hand's forces that differ then", forces, 0, "")};
}

constexpr double kFaceArea = 40e-3 * 6e-3;  // m^2, of the probe's face

/// Shares by which the uppermost fat, muscle and tendon on the face's axis are thinned; nothing:
/// there is none.
struct Thinned {
  bool at_rest = false;
  double force = 0;  // N
  double depth = 0;  // m
  std::optional<double> fat;
  std::optional<double> muscle;
  std::optional<double> tendon;
};

std::optional<double> thinned(const std::vector<LayerBelow>& layers, const CompiledJoint& joint,
                              std::string_view tissue) {
  const auto at = std::find_if(layers.begin(), layers.end(), [&](const LayerBelow& layer) {
    return joint.tissue_of(layer.region).name == tissue;
  });
  if (at == layers.end()) return std::nullopt;
  return at->thinned();
}

Result<Thinned> press_and_measure(SoftBody& body, double force) {
  const CompiledJoint& joint = *body.joint();
  const auto press = press_with(body, joint.X_JP_default, force);
  ARTUS_TRY(press);
  const auto layers = layers_below(*body.snapshot(), joint.X_JP_default);
  return Thinned{press->settled,
                 press->normal_force,
                 press->depth,
                 thinned(layers, joint, "fat"),
                 thinned(layers, joint, "muscle"),
                 thinned(layers, joint, "tendon")};
}

/// kPa: slope of the face's stress over a layer's strain, as the source's moduli are.
double slope(const Thinned& a, const Thinned& b, std::optional<double> Thinned::*layer) {
  return 1e-3 * (b.force - a.force) / kFaceArea / (*(b.*layer) - *(a.*layer));
}

void add_order(Gate& gate, const ClaimBasis& fitted, const Thinned& under) {
  if (under.fat && under.muscle)
    gate.claims.push_back(
        claim_that(fitted, "H2: fat thins more than muscle", *under.fat > *under.muscle));
  if (under.fat && under.tendon)
    gate.claims.push_back(claim_that({ClaimKind::input, "fat is given the lowest stiffness"},
                                     "H2: fat thins more than tendon", *under.fat > *under.tendon));
  if (under.muscle && under.tendon)
    gate.claims.push_back(claim_that({ClaimKind::input, "tendon is given the higher stiffness"},
                                     "H2: muscle thins more than tendon",
                                     *under.muscle > *under.tendon));
}

}  // namespace

Gate gate_still() {
  Gate gate;
  gate.title = "a probe held still on skin, fat and muscle over bone (I7)";
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  gate.claims = claims_of_still_probe(std::make_shared<const CompiledJoint>(
      make_meshed_block(read_bundled_tissues().value(), layers, 64e-3, 48e-3, 4e-3)));
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
  gate.title = joint->name +
               " pressed at its default probe by 3 N (H2), and slopes of stress over compression "
               "around 1 and 5 N against [Isogai2022] (H1)";
  auto body = SoftBody::make(joint, joint->X_JP_default);
  if (!body) {
    gate.claims = {claim_that(ClaimKind::independent, "H2: " + body.error().to_string(), false)};
    return gate;
  }
  std::array<Thinned, 5> under;
  constexpr std::array<double, 5> kForces{0.5, 1.5, kPressedWith, 4, 6};  // N
  bool at_rest = true;
  for (std::size_t i = 0; i < kForces.size(); ++i) {
    const auto pressed = press_and_measure(*body, kForces[i]);
    if (!pressed) {
      gate.claims.push_back(
          claim_that(ClaimKind::independent, "H2: " + pressed.error().to_string(), false));
      return gate;
    }
    under[i] = *pressed;
    at_rest = at_rest && pressed->at_rest;
  }
  gate.claims.push_back(claim_at_rest("H2: the pressed joint", at_rest));
  const ClaimBasis fitted{ClaimKind::fitted,
                          "skin's values were chosen with it in view; the band is assumed"};
  gate.claims.push_back(claim_within(fitted, "H2: 3 N press it by, a shoulder's band",
                                     under[2].depth / kMillimetre, kMiddleOfBand / kMillimetre,
                                     kHalfOfBand / kMillimetre, "mm"));
  add_order(gate, fitted, under[2]);
  const ClaimBasis band{ClaimKind::independent, "the indenter's area is assumed to be the face's"};
  if (under[0].fat)
    gate.claims.push_back(claim_within(band, "H1: fat around 1 N, mean and 2 deviations of 21 men",
                                       slope(under[0], under[1], &Thinned::fat), 26.1, 38.0,
                                       "kPa"));
  if (under[0].muscle)
    gate.claims.push_back(
        claim_within(band, "H1: muscle around 5 N, mean and 2 deviations of 21 men",
                     slope(under[3], under[4], &Thinned::muscle), 62.2, 20.6, "kPa"));
  return gate;
}

}  // namespace artus
