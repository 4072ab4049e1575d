// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/dosing_thumb.h"

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

}  // namespace artus
