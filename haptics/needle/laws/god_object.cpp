// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/god_object.h"

namespace artus {

void GodObject::reset(double /*depth*/) noexcept {}

Wrench GodObject::step(const NeedleTick& tick) noexcept {
  if (tick.dimple <= 0) return {};
  const double below = (tick.entry - tick.tip).dot(tick.surface_normal);
  if (below <= 0) return {};
  return {params_.stiffness * below * tick.surface_normal, Vec3::Zero()};
}

}  // namespace artus
