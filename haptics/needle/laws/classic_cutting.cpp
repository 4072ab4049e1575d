// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/classic_cutting.h"

namespace artus {

void DirectCutting::reset(double /*depth*/) noexcept {}

Wrench DirectCutting::step(const NeedleTick& tick) noexcept {
  const double force = tick.depth > 0 ? -tick.layer.tissue.cutting_force : 0;
  return {force * tick.axis, Vec3::Zero()};
}

void SpringCutting::reset(double /*depth*/) noexcept {}

Wrench SpringCutting::step(const NeedleTick& tick) noexcept {
  const double force = tick.depth > 0 ? -tick.layer.tissue.wall_stiffness * tick.depth : 0;
  return {force * tick.axis, Vec3::Zero()};
}

void VoigtCutting::reset(double /*depth*/) noexcept {}

Wrench VoigtCutting::step(const NeedleTick& tick) noexcept {
  const double force = tick.depth > 0 ? -tick.layer.tissue.wall_stiffness * tick.depth -
                                            params_.damping * tick.velocity
                                      : 0;
  return {force * tick.axis, Vec3::Zero()};
}

}  // namespace artus
