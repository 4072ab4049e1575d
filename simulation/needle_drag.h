// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/soft/solver/soft_solver.h"
#include "artus/echo/needle_view.h"
#include "artus/raycast/scene.h"

namespace artus {

/// In which direction a needle that is drawn was last moved.
enum class NeedleDirection { in, out };

/// What a needle that slides does to the tissue around it, frame J.
struct NeedleDrag {
  std::vector<PointLoad> shaft;  ///< friction, a point every 1.5 mm; where the needle is now
  double push = 0;               ///< m that the tissue before the tip is pushed on
  double tip_force = 0;          ///< N
  RegionId tented = kOutside;    ///< the layer whose membrane holds before the tip, if one does
};

/// Levels are those of the haptic laws at 10 mm/s: along the shaft each layer's friction; going in,
/// the tip pushes the layer that it cuts by that layer's force times the tissue's compliance, and a
/// membrane that it has passed by less than its puncture force pushes it still holds: it is pushed
/// on to the tip. `scene`: the body as it lies without the needle; `tissue_compliance` (m/N) of the
/// point at the tip, which has no more than K_t of a layer leaves it (max_tissue_compliance).
[[nodiscard]] NeedleDrag find_drag(const Scene& scene, const NeedleView& needle,
                                   NeedleDirection path, double tissue_compliance);

}  // namespace artus
