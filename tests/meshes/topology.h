// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// What CGAL, which is not the code under test, says of a surface.
struct Topology {
  bool manifold = false;
  bool closed = false;
  bool outward = false;
  bool self_intersecting = true;
};

[[nodiscard]] Topology compute_topology(const SurfaceMesh& mesh);

}  // namespace artus
