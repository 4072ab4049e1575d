// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/anatomy/body/tet_mesh.h"
#include "artus/anatomy/compile/tet_topology.h"

namespace artus {

/// Which way a complex was filled.
enum class FillMethod {
  quality,  ///< TetGen with quality bounds
  plain,    ///< TetGen without: its refinement gave up
  kept      ///< the mesher's own tetrahedra: TetGen refused the complex
};

/// Fills the complex anew with TetGen: the interfaces and interior vertices of `mesh` are kept,
/// vertices are added inside the regions until dihedral angles and radius-edge ratios are good.
/// TetGen runs in a process of its own, because it aborts and crashes on input it does not like;
/// then the next weaker method is used, so there is always a result. Interfaces must be rebuilt
/// afterwards. Errors: none.
/// Requires: interfaces up to date, vertices ordered (order_vertices).
/// Source: [Si2015].
[[nodiscard]] FillMethod fill_with_tetgen(TetMesh& mesh, const TetNeighbours& neighbours);

}  // namespace artus
