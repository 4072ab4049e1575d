// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/clamping.h"

namespace artus {

double clamping_stiffness(const NeedleTick& tick) noexcept {
  return tick.sum_over_shaft([](const Haptic& h) { return h.clamping_stiffness; }) /
         tick.needle_length;
}

void Clamping::reset(double /*depth*/) noexcept {}

Wrench Clamping::step(const NeedleTick& tick) noexcept {
  if (tick.depth <= 0) return {};
  const Vec3 foot = tick.entry + tick.depth * tick.axis;
  const Vec3 off = tick.tip - foot;
  const double growth = tick.layer.tissue.clamping_stiffness / tick.needle_length;
  return {-clamping_stiffness(tick) * off - 0.5 * growth * off.squaredNorm() * tick.axis,
          Vec3::Zero()};
}

}  // namespace artus
