// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/needle_model.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

template <ForceModel... Laws>
void reset_all(double depth, Laws&... laws) noexcept {
  (laws.reset(depth), ...);
}

/// N along the insertion axis.
template <ForceModel Law>
double axial_force(Law& law, const NeedleTick& tick) noexcept {
  return law.step(tick).force.dot(tick.axis);
}

}  // namespace

NeedleModel::NeedleModel(const NeedleParams& params, const LayerTable& table, double dt) noexcept
    : params_(params),
      contact_(params.contact, params.prepuncture, table, dt),
      wall_(params.wall),
      voigt_(params.voigt),
      prepuncture_(params.prepuncture),
      friction_(dt, params.friction),
      hard_(params.hard),
      orientation_(params.orientation),
      plasticity_(params.plasticity),
      god_object_(params.prepuncture.god_object),
      workspace_(params.workspace),
      coupling_(dt),
      follow_(1 - std::exp(-dt / NeedleCouplingParams{}.relaxation)) {}

void NeedleModel::take(const NeedlePacket& packet) noexcept {
  const Vec3 carried(packet.carried[0], packet.carried[1], packet.carried[2]);
  if (carried.allFinite()) carried_to_ = carried;
  if (packet.compliance_scale >= 0 && packet.compliance_scale <= 1)
    compliance_scale_to_ = packet.compliance_scale;
  if (coupling_.active() || !contact_.inserted()) coupling_.take(packet.compliance);
}

void NeedleModel::reset() noexcept {
  contact_.reset();
  coupling_.reset();
  grip_ = 0;
  felt_ = contact_.tick();
  start_laws();
  forces_ = NeedleForces{};
}

// An insertion begins: what is felt starts from rest at this depth, or, at a puncture, from no more
// than the membrane's force, with nothing cut yet.
void NeedleModel::start_laws() noexcept {
  const NeedleTick& tick = felt_;
  const double x = tick.depth;
  const bool puncture = (contact_.events() & ContactEvent::kSkinPunctured) != 0;
  const double stiffness = std::max(tick.layer.tissue.wall_stiffness, 1e-6);
  wall_.start(puncture ? std::max(0.0, tick.gave_way - tick.torn / stiffness) : x, x);
  reset_all(x, direct_, spring_, voigt_, prepuncture_, friction_, hard_, clamping_, orientation_,
            plasticity_);
}

// The same tissue on a line that moved: what is felt goes on.
void NeedleModel::take_line() noexcept {
  const double by = contact_.tick().line_gain;
  wall_.take_line(by, contact_.tick().line_kept);
  friction_.take_line(by);
  hard_.take_line(by);
  plasticity_.take_line(contact_.tick().line_kept);
}

double NeedleModel::cutting_force(const NeedleTick& tick) noexcept {
  const double wall = axial_force(wall_, tick);  // keeps its memory in every law
  const bool on_bone = tick.depth > tick.bone_depth;
  switch (on_bone ? CuttingLaw::tracking_wall : tick.layer.cutting) {
    case CuttingLaw::direct:
      return axial_force(direct_, tick);
    case CuttingLaw::spring:
      return axial_force(spring_, tick);
    case CuttingLaw::voigt:
      return axial_force(voigt_, tick);
    case CuttingLaw::tracking_wall:
      break;
  }
  return wall;
}

const NeedleForces& NeedleModel::step(const Pose& X_JN,
                                      std::span<const TissueInterval> intervals) noexcept {
  contact_.update(in_material_, intervals, {coupling_.active(), pushed(), carried_});
  to_hand_depth();
  const NeedleTick& tick = felt_;
  forces_ = NeedleForces{};
  if (params_.use_workspace) forces_.workspace = workspace_.step(tick).force;
  if (contact_.inserted()) {
    constexpr std::uint32_t kStart = ContactEvent::kSkinPunctured | ContactEvent::kAdopted;
    if ((contact_.events() & kStart) != 0) start_laws();
    if (tick.line_kept < 1 || tick.line_gain != 0) take_line();
    const double cutting = cutting_force(tick);
    forces_.cutting = std::min(cutting, 0.0);
    forces_.attracted = std::max(cutting, 0.0);
    const bool skin = (contact_.events() & ContactEvent::kSkinPunctured) != 0;
    prepuncture_.tear(tick.torn + (skin ? forces_.cutting : 0), tick.torn_dimple, tick.depth);
    forces_.friction = axial_force(friction_, tick);
    forces_.hard = axial_force(hard_, tick);
    forces_.clamping = params_.clamping == ClampingLaw::projection ? clamping_.step(tick).force
                                                                   : plasticity_.step(tick).force;
    forces_.torque = orientation_.step(tick).torque;
  }
  const bool proxy =
      !contact_.inserted() && tick.membrane.prepuncture == PrepunctureLaw::god_object;
  if (proxy) {
    forces_.surface = god_object_.step(tick).force;
  } else {
    forces_.prepuncture = axial_force(prepuncture_, tick);
  }
  if (coupling_.active()) couple(X_JN);
  sum_up(tick);
  last_tip_ = X_JN.translation() - carried_;
  carried_ += follow_ * (carried_to_ - carried_);
  compliance_scale_ += follow_ * (compliance_scale_to_ - compliance_scale_);
  return forces_;
}

/// The laws' constants were measured at a hand, with all that gives way before the tip in them:
/// they see the hand's depth. Where layers and membranes are met is a matter of the material.
void NeedleModel::to_hand_depth() noexcept {
  felt_ = contact_.tick();
  if (!contact_.inserted()) return;
  felt_.tip += felt_.pushed * felt_.axis;
  felt_.depth += felt_.pushed;
  felt_.bone_depth += felt_.pushed;
  felt_.gave_way += felt_.pushed;
}

/// Where the needle is in the material: back by what the tissue at its tip was moved, by others and
/// by itself.
Pose NeedleModel::material(const Pose& X_JN) const noexcept {
  Pose X = X_JN;
  X.translation() -= carried_;
  if (!coupling_.active()) return X;
  const Vec3 axis = contact_.inserted() ? contact_.tick().axis : Vec3(X_JN.linear().col(2));
  X.translation() -= pushed() * axis;
  return X;
}

/// The tip pushes soft tissue, not the bone under it; the shaft drags what friction holds. How much
/// that is follows the needle's speed within LugreParams::relaxation_time, up and down: at once
/// upward it would be the peaks of an estimated speed, more of which are met at a higher rate.
void NeedleModel::couple(const Pose& X_JN) noexcept {
  const NeedleTick& tick = contact_.tick();
  const double cut = forces_.cutting + forces_.attracted;
  const double held = tick.depth > tick.bone_depth ? tick.layer.tissue.cutting_force : -cut;
  const double tip_force = -forces_.prepuncture + std::min(-cut, held);
  const double level = (1 - tick.stillness) * lugre_level(params_.friction, tick.velocity);
  grip_ += (level - grip_) * (1 - std::exp(-tick.dt / params_.friction.relaxation_time));
  NeedleCompliance::Column limits{};
  for (const ShaftLayer& s : tick.shaft) {
    const Haptic& layer = (*tick.table)[s.region].tissue;
    if (!contact_.inserted() || layer.hard) continue;
    const double per_length = layer.cutting_force * layer.friction / params_.friction.length;
    for (std::size_t i = 0; i < coupling_.points(); ++i)
      limits[i] += grip_ * per_length * coupling_.held_by(i, s.entry, std::min(s.exit, tick.depth));
  }
  const double moved = (X_JN.translation() - carried_ - last_tip_).dot(tick.axis);
  const double moved_in = contact_.inserted() ? moved : 0;
  const Haptic& at_tip = tick.dimple > 0 ? tick.membrane.tissue : tick.layer.tissue;
  forces_.friction = coupling_.step(moved_in, tick.depth, tip_force, at_tip.wall_stiffness, limits);
}

void NeedleModel::sum_up(const NeedleTick& tick) noexcept {
  const double axial =
      forces_.prepuncture + forces_.cutting + forces_.attracted + forces_.friction + forces_.hard;
  forces_.total.force = axial * tick.axis + forces_.clamping + forces_.surface + forces_.workspace;
  forces_.total.torque = forces_.torque;
}

}  // namespace artus
