// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/detail/anatomy/body/tet_mesh.h"

namespace artus {

/// Corners of a piece of wall.
using WallTriangle = std::array<std::uint32_t, 3>;

/// What bounds some regions together (by region; one beyond the list is not among them), in the
/// order of the mesh's interfaces, normals out of them.
[[nodiscard]] std::vector<WallTriangle> walls_of(const TetMesh& mesh,
                                                 const std::vector<bool>& regions);

/// m^3 within walls that close, summed as seen from a point (m): the nearer it is, the less is lost
/// to rounding. `vertices`: m, those of the mesh, wherever they have moved.
[[nodiscard]] double volume_within(std::span<const WallTriangle> walls,
                                   std::span<const Vec3> vertices, const Vec3& from) noexcept;
/// The same, seen from the first corner. Requires: a wall.
[[nodiscard]] double volume_within(std::span<const WallTriangle> walls,
                                   std::span<const Vec3> vertices) noexcept;

}  // namespace artus
