// SPDX-License-Identifier: AGPL-3.0-or-later
#include "haptics/ipc_law.h"

#include <algorithm>
#include <cmath>

namespace artus {

double IpcGains::damping() const noexcept {
  return 2 * std::sqrt((k_1 + k_2) * mass);
}

IpcLaw::IpcLaw(const ControlParams& control, const ServovalveParams& valve,
               bool admittance) noexcept
    : gains_(control.ipc),
      dt_(1 / control.rate),
      centre_(valve.centre_voltage),
      span_(valve.voltage_span),
      admittance_(admittance, control.force_filter, dt_) {}

void IpcLaw::reset(const ControlInput& input) noexcept {
  admittance_.reset(input);
  const double reference = admittance_.step(input);
  // At rest between its springs.
  x_ = (gains_.k_1 * reference + gains_.k_2 * input.measured.y) / (gains_.k_1 + gains_.k_2);
  v_ = 0;
}

ControlOutput IpcLaw::step(const ControlInput& input) noexcept {
  ControlOutput out;
  out.reference = admittance_.step(input);
  const double y = input.measured.y;
  const double force = -gains_.k_1 * (x_ - out.reference) - gains_.k_2 * (x_ - y);
  v_ = (v_ + dt_ * force / gains_.mass) / (1 + dt_ * gains_.damping() / gains_.mass);
  x_ += dt_ * v_;
  const double u = std::clamp(-gains_.k_2 * (y - x_), -span_, span_);
  out.command = {centre_ + u, centre_ - u};
  return out;
}

}  // namespace artus
