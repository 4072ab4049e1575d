// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/needle/plasticity_fixture.h"

namespace artus {

void PlasticityFixture::reset(double /*depth*/) noexcept {
  place_.setZero();
  last_.setZero();
}

Wrench PlasticityFixture::step(const NeedleTick& tick) noexcept {
  const Vec3 p = tick.tip - tick.entry - tick.depth * tick.axis;
  const double k = params_.stiffness + params_.damping / tick.dt;
  const double share = params_.damping / (params_.stiffness * tick.dt + params_.damping);
  const Vec3 input = p + share * (place_ - last_);
  Vec3 stretch = place_ - input;
  const double most = params_.yield_force / k;
  const double norm = stretch.norm();
  if (norm > most) stretch *= most / norm;
  place_ = input + stretch;
  last_ = p;
  return {k * stretch, Vec3::Zero()};
}

}  // namespace artus
