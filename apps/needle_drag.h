// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/echo/needle_view.h"
#include "artus/raycast/scene.h"
#include "artus/soft/soft_solver.h"

namespace artus {

/// Which way a needle that is drawn was last moved.
enum class NeedleWay { in, out };

/// What a needle that slides puts on the tissue around it, as points every 1.5 mm, frame J: along
/// the shaft each layer's friction, at the tip, going in, the force that cuts the layer there. The
/// levels are those of the haptic laws at 10 mm/s. `scene`: the body as it lies; points are where
/// the needle is in it, which is not where they were at rest.
[[nodiscard]] std::vector<PointLoad> sliding_loads(const Scene& scene, const NeedleView& needle,
                                                   NeedleWay way);

}  // namespace artus
