// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <limits>

#include "artus/core/result.h"
#include "artus/detail/anatomy/body/tet_mesh.h"

namespace artus {

inline constexpr std::uint32_t kNoTet = std::numeric_limits<std::uint32_t>::max();

/// Neighbours of tetrahedra: (n_tets), entry k across the face opposite vertex k, or kNoTet.
using TetNeighbours = std::vector<std::array<std::uint32_t, 4>>;

/// The face opposite vertex `k`, counter-clockwise seen from outside the tetrahedron.
[[nodiscard]] std::array<std::uint32_t, 3> tet_face(const std::array<std::uint32_t, 4>& tet,
                                                    int k) noexcept;

/// Finds who shares each face. Cost: n log n. Errors: failed when a face has more than two owners.
[[nodiscard]] Result<TetNeighbours> find_tet_neighbours(const TetMesh& mesh);

/// Connected parts of one region: (n_tets) part of each tetrahedron, numbered in order of their
/// first tetrahedron.
struct TetParts {
  std::vector<std::uint32_t> part;
  std::vector<double> volume;    ///< (n_parts), m^3
  std::vector<RegionId> region;  ///< (n_parts)
};
[[nodiscard]] TetParts find_tet_parts(const TetMesh& mesh, const TetNeighbours& neighbours);

/// Gives parts smaller than `smallest(region)` (m^3) to the neighbour they share most area with,
/// unless a part is the largest of its region. Such fragments appear where two surfaces nearly
/// coincide. Returns how many changed hands.
std::size_t merge_fragments(TetMesh& mesh, const TetNeighbours& neighbours,
                            const std::function<double(RegionId)>& smallest);

/// Replaces mesh.interfaces by the faces between different regions and the hull's faces, whose
/// front is what `front_of_hull` says at their centroid.
void rebuild_interfaces(TetMesh& mesh, const TetNeighbours& neighbours,
                        const std::function<RegionId(const Vec3&)>& front_of_hull);

/// Renumbers the vertices so that those on interfaces come first; drops unused ones. The order is
/// otherwise kept.
void order_vertices(TetMesh& mesh);

/// Volume of each region, m^3, (n_regions).
[[nodiscard]] std::vector<double> region_volumes(const TetMesh& mesh, std::size_t n_regions);

}  // namespace artus
