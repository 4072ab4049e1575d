// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/simulated_hands.h"

namespace artus {

void SimulatedHands::hold_probe(const std::optional<Pose>& X_WP) noexcept {
  sample_.has_probe = X_WP ? 1 : 0;
  if (X_WP) sample_.X_WP = to_plain(*X_WP);
}

const DeviceSample& SimulatedHands::read(const OperatorPhase* phase) noexcept {
  sample_.state = PeerState::alive;
  sample_.has_needle = needle_ ? 1 : 0;
  if (needle_) sample_.X_WN = to_plain(needle_->measured());
  if (thumb_) thumb_->press(phase, sample_);
  ++sample_.number;
  return sample_;
}

void SimulatedHands::feel(const DeviceFeedback& feedback) noexcept {
  const auto& f = feedback.force;
  const auto& t = feedback.torque;
  motor_ = {Vec3(f[0], f[1], f[2]), Vec3(t[0], t[1], t[2])};
  if (thumb_) thumb_->feel(feedback.plunger);
}

}  // namespace artus
