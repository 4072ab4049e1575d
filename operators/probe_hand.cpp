// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/probe_hand.h"

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

ProbeHand::ProbeHand(const ProbeHandParams& params, double rate_hz, const Pose& seat)
    : params_(params),
      loop_({rate_hz, kPhysicsRate}, params.device, params.hand, lifted(seat, params.standoff)) {}

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

RigidProbeHand::RigidProbeHand(std::shared_ptr<const Scene> scene, const ProbeHandParams& params,
                               double rate_hz, const Pose& seat)
    : hand_(params, rate_hz, seat),
      contact_(std::move(scene), params.contact),
      guard_(params.guard, params.device, 1 / rate_hz) {}

ProbeHandRow RigidProbeHand::feel() {
  ProbeHandRow row;
  row.X_JP = hand_.measured();
  row.energy_to_hand = hand_.energy_to_hand();
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
  return row;
}

}  // namespace artus
