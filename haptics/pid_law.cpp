// SPDX-License-Identifier: AGPL-3.0-or-later
#include "haptics/pid_law.h"

#include <algorithm>
#include <cmath>

namespace artus {

PidLaw::PidLaw(const ControlParams& control, const ServovalveParams& valve,
               bool admittance) noexcept
    : gains_(control.pid),
      dt_(1 / control.rate),
      centre_(valve.centre_voltage),
      span_(valve.voltage_span),
      admittance_(admittance, control.force_filter, dt_),
      derivative_(control.velocity_filter, dt_) {}

void PidLaw::reset(const ControlInput& input) noexcept {
  admittance_.reset(input);
  derivative_.reset(0);
  integral_ = 0;
  last_error_ = admittance_.step(input) - input.measured.y;
}

ControlOutput PidLaw::step(const ControlInput& input) noexcept {
  ControlOutput out;
  out.reference = admittance_.step(input);
  const double error = out.reference - input.measured.y;
  const double rate = derivative_.step((error - last_error_) / dt_);
  last_error_ = error;
  const double grown = std::clamp(integral_ + gains_.integral * error * dt_, -gains_.integral_limit,
                                  gains_.integral_limit);
  const double free = gains_.proportional * error + gains_.derivative * rate;
  if (std::abs(free + grown) < span_) integral_ = grown;
  const double u = std::clamp(free + integral_, -span_, span_);
  out.command = {centre_ + u, centre_ - u};
  return out;
}

}  // namespace artus
