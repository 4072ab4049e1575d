// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/probe_hand.h"

#include <algorithm>
#include <utility>

namespace artus {
namespace {

constexpr double kPhysicsRate = 20000;  // Hz

Pose lifted(const Pose& X_JP, double height) {
  Pose pose = X_JP;
  pose.translation() -= height * X_JP.linear().col(2);
  return pose;
}

}  // namespace

Pose ProbeHandRow::image_pose() const {
  return lifted(X_JP, indentation);
}

ProbeHand::ProbeHand(std::shared_ptr<const Scene> scene, const ProbeHandParams& params,
                     double rate_hz, const Pose& seat)
    : params_(params),
      loop_({rate_hz, kPhysicsRate}, params.device, params.hand, lifted(seat, params.standoff)),
      contact_(std::move(scene), params.contact),
      guard_(params.guard, params.device, 1 / rate_hz) {
  const ProbeContactParams& skin = params.contact;
  if (params.packet_rate > 0)
    tissue_.emplace(rate_hz, params.packet_rate, skin.gel ? skin.gel_friction : skin.dry_friction);
}

void ProbeHand::take(const ProbePacket& packet) noexcept {
  constexpr std::size_t kAlongBeam = 14;  // of the 6 by 6
  if (!tissue_) return;
  tissue_->take(packet);
  tissue_stiffness_ = packet.stiffness[kAlongBeam];
}

ProbeHandRow ProbeHand::feel() {
  ProbeHandRow row;
  row.X_JP = loop_.measured();
  row.energy_to_hand = loop_.energy_to_hand();
  if (tissue_)
    feel_tissue(row);
  else
    feel_columns(row);
  return row;
}

void ProbeHand::feel_tissue(ProbeHandRow& row) {
  const Wrench& wrench = tissue_->step(row.X_JP);
  const Vec3 beam = row.X_JP.linear().col(2);
  row.normal_force = std::max(0.0, -wrench.force.dot(beam));
  row.friction = wrench.force - wrench.force.dot(beam) * beam;
  row.torque = wrench.torque;
  row.stiffness = tissue_stiffness_;
  row.contact_share = tissue_->share();
  command_ = guard_.apply(wrench, TickStatus::kOk, row.status);
}

void ProbeHand::feel_columns(ProbeHandRow& row) {
  const ProbeContact& contact = contact_.step(row.X_JP);
  row.normal_force = contact.normal_force;
  row.edge_force = contact.edge_force;
  row.friction = contact.friction;
  row.torque = contact.wrench.torque;
  row.slip = contact.slip;
  row.stiffness = contact.stiffness;
  row.indentation = contact.indentation;
  row.contact_share = contact.contact_share;
  row.status = contact.status;
  command_ = guard_.apply(contact.wrench, contact.status, row.status);
}

/// The hand's spring leads to the wanted place along the skin, but along the beam it pushes with a
/// steady force from wherever the probe is.
Intention ProbeHand::lean(const ProbeIntention& wanted) const {
  const Vec3 axis = wanted.X_JP.linear().col(2);
  const Vec3 seat = wanted.X_JP.translation();
  const double depth = axis.dot(loop_.motion().X_JN.translation() - seat);
  const double pressed = depth + params_.press_force / params_.hand.stiffness;
  const double aim = (1 - wanted.lift) * pressed - wanted.lift * (params_.standoff + wanted.rise);
  Intention intention;
  intention.X_JN = wanted.X_JP;
  intention.X_JN.translation() = seat + aim * axis;
  return intention;
}

}  // namespace artus
