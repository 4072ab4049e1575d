// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/admittance_law.h"

#include <algorithm>

namespace artus {

void AdmittanceLaw::reset(const ControlInput& input) noexcept {
  admittance_.reset(input);
  start(admittance_.step(input), input.measured.y);
}

ControlOutput AdmittanceLaw::step(const ControlInput& input) noexcept {
  ControlOutput out;
  out.reference = admittance_.step(input);
  const double u = std::clamp(drive(out.reference, input.measured.y), -span_, span_);
  out.command = {centre_ + u, centre_ - u};
  return out;
}

}  // namespace artus
