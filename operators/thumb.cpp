// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/thumb.h"

#include <algorithm>

namespace artus {

PlungerInput Thumb::step(const OperatorPhase* phase, const PlungerState& plunger, double area,
                         double dt) noexcept {
  constexpr double kAllOfIt = 0.99;  // of the strongest push
  PlungerInput input;
  strains_ = false;
  const bool by_rate = phase != nullptr && phase->thumb_rate > 0;
  if (!by_rate) {
    pressing_ = false;
    if (phase == nullptr) return input;
    // What the barrel pushes back with: between the two the stopper's friction keeps it.
    const double back = std::clamp(area * plunger.pressure, 0.0, params_.max_force);
    input.force = phase->thumb_holds ? back : phase->thumb_force;
    return input;
  }
  if (!pressing_) position_ = plunger.travel;
  pressing_ = true;
  position_ += phase->thumb_rate / area * dt;
  const double max_ahead = params_.max_force / params_.stiffness;
  position_ = std::min(position_, plunger.travel + max_ahead);
  strains_ = position_ - plunger.travel >= kAllOfIt * max_ahead;
  input.position = position_;
  input.stiffness = params_.stiffness;
  return input;
}

}  // namespace artus
