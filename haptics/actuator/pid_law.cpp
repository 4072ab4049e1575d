// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/pid_law.h"

#include <algorithm>
#include <cmath>

namespace artus {

void PidLaw::start(double reference, double y) noexcept {
  derivative_.reset(0);
  integral_ = 0;
  last_error_ = reference - y;
}

double PidLaw::drive(double reference, double y) noexcept {
  const double error = reference - y;
  const double rate = derivative_.step((error - last_error_) / period());
  last_error_ = error;
  const double grown = std::clamp(integral_ + gains_.integral * error * period(),
                                  -gains_.integral_limit, gains_.integral_limit);
  const double free = gains_.proportional * error + gains_.derivative * rate;
  if (std::abs(free + grown) < span()) integral_ = grown;
  return free + integral_;
}

}  // namespace artus
