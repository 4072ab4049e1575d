// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"
#include "artus/detail/meshes/generate/solids/field.h"

namespace artus {

/// A solid to be turned into triangles.
struct Solid {
  std::string name;           ///< file stem
  Field field;                ///< one connected piece
  Vec3 seed = Vec3::Zero();   ///< a point well inside
  double reach = 0;           ///< m, the ball (seed, reach) holds the solid with room to spare
  double facet_size = 0;      ///< m, longest circumradius of a triangle
  double facet_distance = 0;  ///< m, how far a triangle may stray from the surface
};

/// The solid's surface: closed, manifold, wound outward, free of self-intersections, the same
/// bytes for the same solid. Errors: failed (seed outside, reach too short, no closed surface).
/// Cost: some tens of thousand triangles per second and microsecond of field.
[[nodiscard]] Result<SurfaceMesh> compute_surface(const Solid& solid);

}  // namespace artus
