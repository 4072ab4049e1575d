// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/probe/placed_line.h"

namespace artus {

PlacedLine place_line(const Transducer& probe, int index, const Pose& X_JP) noexcept {
  PlacedLine placed;
  placed.index = index;
  placed.line = scanline(probe, index);
  placed.across = Vec3(placed.line.direction.z(), 0, -placed.line.direction.x());
  placed.origin_J = X_JP * placed.line.origin;
  placed.direction_J = X_JP.linear() * placed.line.direction;
  placed.elevation_J = X_JP.linear().col(1);
  return placed;
}

}  // namespace artus
