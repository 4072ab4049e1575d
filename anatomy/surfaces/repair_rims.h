// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "artus/detail/anatomy/surfaces/surface_mesh.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"

namespace artus {

using Rim = std::vector<std::uint32_t>;

/// The shape of an opening.
struct RimShape {
  Vec3 centre = Vec3::Zero();  ///< mean of its vertices
  Vec3 normal = Vec3::Zero();  ///< unit, of the patch that would close it
  double area = 0;             ///< m^2, seen along the normal
  double perimeter = 0;        ///< m
  double radius = 0;           ///< m, mean distance of its vertices from the centre
  double bend = 0;             ///< largest distance from its plane, in radii

  /// A cut by a plane, to rounding.
  [[nodiscard]] bool is_planar() const noexcept;
  /// A cut along the triangles' edges: its teeth leave the plane by little.
  [[nodiscard]] bool is_jagged() const noexcept;
  /// As a vessel's end: 1 for a circle, 4 pi area / perimeter^2.
  [[nodiscard]] double roundness() const noexcept;
  /// Mean width, m; a crack has next to none.
  [[nodiscard]] double width() const noexcept;
};
[[nodiscard]] RimShape measure_rim(const SurfaceMesh& mesh, const Rim& rim);

/// Whether `inner` is a hole in the cut that `outer` bounds: in its plane, inside it, and running
/// the other way.
[[nodiscard]] bool is_hole_in(const SurfaceMesh& mesh, const Rim& inner,
                              const RimShape& inner_shape, const Rim& outer,
                              const RimShape& outer_shape);

/// The triangles between the first rim and the rims in it, seen along `normal`; vertices are added
/// in the middle of sides that the mesh has already (`uses` is the mesh's); vertices of the mesh
/// that are to lie in it are `inner`. Empty, and the mesh as it was, when a rim crosses itself or
/// another one in that view. Cost: n log n.
[[nodiscard]] std::vector<Triangle> triangulate_flat(SurfaceMesh& mesh,
                                                     const std::vector<EdgeUse>& uses,
                                                     const std::vector<Rim>& rims,
                                                     const Vec3& normal, Rim inner = {});

/// Is there an edge between two vertices?
[[nodiscard]] bool has_edge(const std::vector<EdgeUse>& uses, std::uint32_t a, std::uint32_t b);

/// Do sides of the patch that are not on the rim exist in the mesh already? `uses` is the mesh's.
[[nodiscard]] bool crowds_an_edge(const std::vector<EdgeUse>& uses,
                                  const std::vector<Triangle>& patch, const Rim& rim);

}  // namespace artus
