// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/needle/release.h"

#include <algorithm>
#include <cmath>

namespace artus {

Release measure_release(std::span<const NeedleRow> rows, double from, double until,
                        const DeviceLimits& device) {
  Release release;
  release.from = from;
  double held = 0;
  double energy = 0;
  bool opening = false;
  bool open = false;
  for (const NeedleRow& row : rows) {
    const double z = row.needle.X_JN.translation().z();
    if (row.time > until) break;
    if (row.time < from || !opening) {
      held = z;
      energy = row.energy_to_hand;
    }
    if (row.time < from) continue;
    opening = true;
    release.moved = std::max(release.moved, held - z);
    if (open || row.hand.norm() > 0) continue;
    open = true;
    release.open = row.time;
    const double worked = std::max(0.0, row.energy_to_hand - energy);
    const double v = row.needle.velocity.z();
    const double of_hand = std::sqrt(std::max(0.0, v * v - 2 * worked / device.mass));
    release.momentum = of_hand * device.mass / device.damping;
  }
  return release;
}

}  // namespace artus
