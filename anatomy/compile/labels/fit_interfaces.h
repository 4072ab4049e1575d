// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/anatomy/compile/labels/region_labels.h"

namespace artus {

/// Moves interface vertices so that the average signed distance of the triangles around each is
/// zero. A mesher puts vertices on the surface, so the triangles of a convex part lie inside it
/// and its volume shrinks (a tube of few sides by 10 %); balanced about the surface they keep it.
/// No tetrahedron loses more than part of its volume. Deterministic. Cost: linear.
/// Requires: interfaces up to date.
void fit_interfaces(TetMesh& mesh, const RegionLabels& labels);

}  // namespace artus
