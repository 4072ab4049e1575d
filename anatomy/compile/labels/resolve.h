// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/anatomy/compile/labels/region_labels.h"
#include "artus/detail/core/progress.h"

namespace artus {

/// How fine one region's surface and inside are.
struct RegionSizing {
  double facet_size = 0;      ///< m, longest circumradius of an interface triangle
  double facet_distance = 0;  ///< m, how far a triangle may stray from the surface
  double cell_size = 0;       ///< m, longest circumradius of a tetrahedron
};

struct ResolveOptions {
  Box box;                           ///< encloses what is to be meshed
  std::vector<RegionSizing> sizing;  ///< (n_regions)
  double seed_spacing = 0.5e-3;      ///< m, grid that searches for every part of every region
};

/// Meshes the labelled regions into one conforming complex: Delaunay refinement restricted to the
/// labels' boundaries, started from points on every boundary so that no small part is missed. The
/// tetrahedra between them are as they come, large and flat ones among them: see fill_with_tetgen.
/// Errors: failed when nothing is inside, or the mesher gives up.
/// Source: [Boissonnat2005]; [CGAL] Mesh_3.
[[nodiscard]] Result<TetMesh> resolve_regions(const RegionLabels& labels,
                                              const ResolveOptions& options,
                                              const Progress& progress = {});

}  // namespace artus
