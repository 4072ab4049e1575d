// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/core/geometry.h"
#include "artus/detail/training/health/slice_wall.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// A stretch of a beam in a space, m from the face.
struct BeamStretch {
  double roof = 0;
  double floor = 0;
};
using BeamWalls = std::vector<std::vector<BeamStretch>>;  ///< (n_beams), by depth

/// Beams this far apart at the face, m; a linear probe's stay so.
inline constexpr double kBeamSpacing = 0.2e-3;

/// The same probe with beams so far apart.
[[nodiscard]] Transducer spaced_evenly(const Transducer& transducer);

/// Where the beams of a probe meet these regions (by RegionId), to `depth` m. Stretches of several
/// of them that follow each other are one. Cost: a query a beam.
[[nodiscard]] BeamWalls find_walls(const Scene& scene, const Pose& X_JP,
                                   const Transducer& transducer, double depth,
                                   const std::vector<bool>& regions);

/// By how much a wall jumps from each beam to the next, m (n_beams - 1): the largest of roofs and
/// floors of stretches that lie beside each other; of a stretch that has none beside it, half of
/// its length, since its walls meet at once, and so of tissue that begins in a stretch. Less three
/// times what the same wall rises or falls the same way a beam before and behind, whichever is
/// less: where a round wall lies along the beams it is as steep as one likes, but comes to it. None
/// where the wall between the two beams was half as long before: one that has turned or stretched
/// is whole, a ledge is not. `wall`: null: nothing is known of that.
[[nodiscard]] std::vector<double> wall_steps(const BeamWalls& walls, const SliceWall* wall);

/// A wall that jumps though the body at rest does not.
struct WallJump {
  double jump = 0;       ///< m, beyond the largest jump at rest within 3 mm beside
  std::size_t beam = 0;  ///< the first of the two
};

/// The largest. `wall`: of `after`, or null. Requires: as many beams in both.
[[nodiscard]] WallJump find_wall_jump(const BeamWalls& before, const BeamWalls& after,
                                      const SliceWall* wall = nullptr);

}  // namespace artus
