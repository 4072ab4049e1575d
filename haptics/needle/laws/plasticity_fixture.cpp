// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/plasticity_fixture.h"

namespace artus {
namespace {
// Off the line, m.
Vec3 lateral(const NeedleTick& tick, const Vec3& p) noexcept {
  const Vec3 from_entry = p - tick.entry;
  return from_entry - from_entry.dot(tick.axis) * tick.axis;
}
}  // namespace

void PlasticityFixture::reset(double /*depth*/) noexcept {
  place_.setZero();
  begun_ = false;
}

void PlasticityFixture::take_line(double kept) noexcept {
  place_ *= kept;
}

Wrench PlasticityFixture::step(const NeedleTick& tick) noexcept {
  const Vec3 p = lateral(tick, tick.tip);
  const Vec3 last = begun_ ? lateral(tick, last_tip_) : place_;
  const double k = params_.stiffness + params_.damping / tick.dt;
  const double share = params_.damping / (params_.stiffness * tick.dt + params_.damping);
  const Vec3 input = p + share * (place_ - last);
  Vec3 stretch = place_ - input;
  const double max = params_.yield_force / k;
  const double norm = stretch.norm();
  if (norm > max) stretch *= max / norm;
  place_ = input + stretch;
  last_tip_ = tick.tip;
  begun_ = true;
  return {k * stretch, Vec3::Zero()};
}

}  // namespace artus
