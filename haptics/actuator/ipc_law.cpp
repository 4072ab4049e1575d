// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/ipc_law.h"

#include <cmath>

namespace artus {

double IpcGains::damping() const noexcept {
  return 2 * std::sqrt((k_1 + k_2) * mass);
}

void IpcLaw::start(double reference, double y) noexcept {
  // At rest between its springs.
  x_ = (gains_.k_1 * reference + gains_.k_2 * y) / (gains_.k_1 + gains_.k_2);
  v_ = 0;
}

double IpcLaw::drive(double reference, double y) noexcept {
  const double dt = period();
  const double force = -gains_.k_1 * (x_ - reference) - gains_.k_2 * (x_ - y);
  v_ = (v_ + dt * force / gains_.mass) / (1 + dt * gains_.damping() / gains_.mass);
  x_ += dt * v_;
  return -gains_.k_2 * (y - x_);
}

}  // namespace artus
