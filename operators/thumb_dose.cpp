// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/operators/thumb_dose.h"

#include <algorithm>

namespace artus {

double after_flow(const Syringe& syringe, double pressure, double tip_pressure) noexcept {
  return syringe.softness() * std::max(0.0, pressure - tip_pressure);
}

double run_out_time(const PlungerParams& params) {
  constexpr double kShortest = 1.5;  // s; assumed
  constexpr double kLongest = 10;    // s
  constexpr double kTimes = 5;
  const NeedleFlow bore(params.needle, params.liquid.viscosity, params.liquid.density);
  return std::clamp(kTimes * bore.resistance() * params.syringe.softness(), kShortest, kLongest);
}

ThumbDose::ThumbDose(const PlungerParams& params, double volume)
    : syringe_(params.syringe), volume_(volume), run_out_(run_out_time(params)) {
  hold_.thumb_holds = true;
}

void ThumbDose::step(bool pushes, double given, double pressure, double tip_pressure, double flow,
                     double dt) noexcept {
  if (enough_) {
    held_ += dt;
    return;
  }
  if (!pushes) return;
  in_vain_ = flow > kFlows ? 0 : in_vain_ + dt;
  const double rest = flow > kFlows ? after_flow(syringe_, pressure, tip_pressure) : 0;
  enough_ = given - before_ + rest >= volume_ || in_vain_ > kPatience;
}

}  // namespace artus
