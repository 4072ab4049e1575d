// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>

#include "artus/core/geometry.h"
#include "artus/detail/anatomy/body/tet_mesh.h"

namespace artus {

/// The plane of one interface triangle in double precision, relative to the scene's centre. Half
/// a cache line: a query reads a few of these at random places.
struct FacetPlane {
  Vec3 normal = Vec3::Zero();  ///< unit, from back to front; zero for a triangle without area
  double offset = 0;           ///< m, normal . p for the points p of the plane
};

/// The regions on the two sides of one interface triangle.
struct FacetSides {
  RegionId front = kOutside;
  RegionId back = kOutside;
};

/// What a hit needs to know of its facet: one cache line, so that a hit costs one miss.
struct alignas(64) Facet {
  FacetPlane plane;
  FacetSides sides;
};

/// One passage of a line through a facet. Without initialisers: a query's room for hits is on its
/// stack, and clearing it would cost more than half a query.
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): see above
struct Hit {
  double depth;             ///< m along the line
  std::uint32_t interface;  ///< index into TetMesh::interfaces
  RegionId from;            ///< region before it
  RegionId to;              ///< region after it
};

/// Hits one query can hold; a line through more surfaces keeps the nearest.
inline constexpr std::size_t kMaxHits = 256;

}  // namespace artus
