// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/operators/thumb_dose.h"

#include <algorithm>

namespace artus {

double after_flow(const Syringe& syringe, double pressure, double tip_pressure,
                  bool holds) noexcept {
  const bool slides_back = !holds && pressure * syringe.area() > syringe.break_loose;
  const double held = slides_back ? syringe.glide / syringe.area() : pressure;
  return syringe.softness() * std::max(0.0, held - tip_pressure);
}

void ThumbDose::step(bool pushes, double given, double pressure, double tip_pressure, double flow,
                     double dt) noexcept {
  if (!pushes || enough_) return;
  in_vain_ = flow > kFlows ? 0 : in_vain_ + dt;
  const double rest = flow > kFlows ? after_flow(syringe_, pressure, tip_pressure, holds_) : 0;
  enough_ = given - before_ + rest >= volume_ || in_vain_ > kPatience;
}

}  // namespace artus
