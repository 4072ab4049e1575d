// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

/// Three vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// An indexed triangle surface as a file gave it or a repair left it; metres. Not necessarily
/// closed, oriented or manifold: find_defects tells.
struct SurfaceMesh {
  std::vector<Vec3> vertices;       ///< (n_vertices)
  std::vector<Triangle> triangles;  ///< (n_triangles), indices into vertices
};

/// Copies the arrays into a mesh. Errors: malformed when an index is out of range.
[[nodiscard]] Result<SurfaceMesh> make_surface_mesh(std::span<const Vec3> vertices,
                                                    std::span<const Triangle> triangles);

/// Volume enclosed by a closed surface, m^3; negative when it is wound inward. Meaningless for an
/// open one. Cost: linear.
[[nodiscard]] double signed_volume(const SurfaceMesh& mesh) noexcept;

/// Area of a triangle of the mesh, m^2.
[[nodiscard]] double triangle_area(const SurfaceMesh& mesh, const Triangle& t) noexcept;

/// Mean of a triangle's corners.
[[nodiscard]] Vec3 triangle_centre(const SurfaceMesh& mesh, const Triangle& t) noexcept;

/// Sum of the triangles' areas, m^2.
[[nodiscard]] double surface_area(const SurfaceMesh& mesh) noexcept;

}  // namespace artus
