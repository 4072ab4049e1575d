// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/thumb_dose.h"

#include <algorithm>
#include <cmath>

namespace artus {

double run_out_time(const PlungerParams& params) {
  constexpr double kShortest = 1.5;  // s; assumed
  constexpr double kLongest = 10;    // s
  constexpr double kTimes = 5;
  const NeedleFlow bore(params.needle, params.liquid.viscosity, params.liquid.density);
  return std::clamp(kTimes * bore.resistance() * params.syringe.softness(), kShortest, kLongest);
}

/// Falling from p to q takes the softness times the integral of dp/Q from q to p; over the
/// logarithm of the pressure that is p/Q, summed up from the lowest. What is below it is gone. How
/// soft trapped air is while it falls is taken of the atmosphere around the bevel.
HeldBarrel::HeldBarrel(const PlungerParams& params, double seconds)
    : syringe_(params.syringe), points_per_octave_((kPoints - 1) / std::log2(kMax / kMin)) {
  const NeedleFlow bore(params.needle, params.liquid.viscosity, params.liquid.density,
                        params.entry_loss);
  const auto pressure_at = [this](double point) {
    return kMin * std::exp2(point / points_per_octave_);
  };
  constexpr int kSubsteps = 8;
  std::array<double, kPoints> since{};  // s from the lowest
  const double step = std::log(2.0) / (points_per_octave_ * kSubsteps);
  for (std::size_t i = 1; i < kPoints; ++i) {
    since[i] = since[i - 1];
    for (int k = 0; k < kSubsteps; ++k) {
      const double p = pressure_at(static_cast<double>(i - 1) + (k + 0.5) / kSubsteps);
      since[i] += syringe_.softness(p) * p / bore.flow(p) * step;
    }
  }
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double left = since[i] - seconds;
    share_[i] = 1;
    if (left < 0) continue;
    std::size_t low = i - 1;
    while (since[low] > left) --low;
    const double part = (left - since[low]) / (since[low + 1] - since[low]);
    share_[i] -= pressure_at(static_cast<double>(low) + part) / pressure_at(static_cast<double>(i));
  }
}

double HeldBarrel::gives(double over, double around) const noexcept {
  if (!(over > 0)) return 0;
  const double last = static_cast<double>(kPoints - 1);
  const double at = std::clamp(std::log2(over / kMin) * points_per_octave_, 0.0, last);
  const auto low = static_cast<std::size_t>(std::min(at, last - 1));
  const double part = at - static_cast<double>(low);
  const double share = share_[low] + part * (share_[low + 1] - share_[low]);
  return syringe_.squeezed(around + over) - syringe_.squeezed(around + (1 - share) * over);
}

ThumbDose::ThumbDose(const PlungerParams& params, double volume)
    : volume_(volume), run_out_(run_out_time(params)), barrel_(params, run_out_) {
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
  const double rest = flow > kFlows ? barrel_.gives(pressure - tip_pressure, tip_pressure) : 0;
  enough_ = given - before_ + rest >= volume_ || in_vain_ > kPatience;
}

}  // namespace artus
