// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/soft/liquid/space_walls.h"

namespace artus {

/// What tetrahedra that were turned over are put right by.
struct Unfolding {
  std::vector<bool> held;           ///< by vertex: does not move
  std::vector<bool> loose;          ///< by region: liquid, which has no shape
  std::vector<WallTriangle> walls;  ///< of the liquid, of tetrahedra's corners; normals out of it
  std::vector<WallTriangle> finer;  ///< the same as it is drawn, which may be cut finer
};

/// Moves vertices until no tetrahedron of tissue is turned over or squeezed to a twentieth, as few
/// of them as that takes: where some are, they and those around them take the shapes that are least
/// drawn out and squeezed against `rest`, pressed from within by liquid that keeps its volume; all
/// others stay. A map that folds nothing may still turn over a tetrahedron that is larger than what
/// it bends over, or that lies across the rim of what is torn open. Vertices of no tetrahedron go
/// with the one that they lie in. False: some could not be put right, and nothing has moved.
/// Requires: as many vertices in both. Cost: linear in tetrahedra where there is nothing to do,
/// else some 10 us for each vertex beside, for each of 10 to 180 sweeps.
/// Source: [Garanzha2021], an energy that is finite for what is turned over, and hardens.
bool unfold(const TetMesh& rest, const Unfolding& unfolding, std::vector<Vec3>& moved);

}  // namespace artus
