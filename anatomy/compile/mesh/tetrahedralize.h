// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>

#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/anatomy/compile/labels/resolve.h"
#include "artus/detail/anatomy/compile/mesh/tet_topology.h"

namespace artus {

/// Which way a complex was filled.
enum class FillMethod {
  quality,  ///< TetGen with quality bounds
  plain,    ///< TetGen without: its refinement gave up
  kept      ///< the mesher's own tetrahedra: TetGen refused the complex
};

/// Fills the complex anew with TetGen: the interfaces and interior vertices of `mesh` are kept,
/// vertices are added inside the regions until dihedral angles and radius-edge ratios are good.
/// The parts of the regions are filled in a few groups, each by itself, since no interface changes.
/// TetGen runs in processes of its own, because it aborts and crashes on input it does not like;
/// then the next weaker method is used for that group, so there is always a result; the weakest one
/// used is returned. Interfaces must be rebuilt afterwards. Errors: none.
/// `sizing` bounds the tetrahedra of each region (n_regions): none is larger than the regular one
/// of circumradius cell_size, unless the interfaces' triangles around are; empty: no bound.
/// Requires: interfaces up to date, vertices ordered (order_vertices). Source: [Si2015].
[[nodiscard]] FillMethod fill_with_tetgen(TetMesh& mesh, const TetNeighbours& neighbours,
                                          std::span<const RegionSizing> sizing = {});

}  // namespace artus
