// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/simulated_hands.h"

#include "artus/detail/simulation/syringe_core.h"

namespace artus {

DosingThumb::DosingThumb(const PlungerParams& params, double volume, double rate_hz)
    : area_(params.syringe.area()),
      period_(1 / rate_hz),
      thumb_({SyringeCore::kCoupling, SyringeCore::kMaxForce}),
      dose_(params, volume) {}

void DosingThumb::press(const OperatorPhase* phase, DeviceSample& sample) noexcept {
  doses_ = phase != nullptr && phase->until_given;
  PlungerState plunger;
  plunger.travel = felt_.travel;
  plunger.pressure = felt_.pressure;
  const PlungerInput request =
      thumb_.step(doses_ ? dose_.present(phase) : phase, plunger, area_, period_);
  sample.plunger = request.stiffness > 0 ? PlungerSign::travel : PlungerSign::force;
  sample.plunger_travel = request.position;
  sample.plunger_force = request.force;
}

void DosingThumb::feel(const PlungerFeedback& felt) noexcept {
  felt_ = felt;
  const bool pushes = doses_ && (felt.flow > ThumbDose::kFlows || thumb_.strains());
  dose_.step(pushes, felt.given, felt.pressure, felt.tip_pressure, felt.flow, period_);
}

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
