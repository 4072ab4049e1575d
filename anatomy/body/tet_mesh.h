// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "artus/core/geometry.h"

namespace artus {

/// Index of a region (one structure's share of the body, or the filler) in CompiledJoint::regions.
using RegionId = std::uint16_t;
inline constexpr RegionId kOutside = 0;  ///< outside the skin: air or gel
inline constexpr RegionId kBeyond = 1;   ///< inside the body, outside the region of interest
inline constexpr RegionId kFirstRegion = 2;

/// A surface element between two regions. Its normal (right-hand rule) points from back to front.
struct Interface {
  std::array<std::uint32_t, 3> vertices{};
  RegionId front = kOutside;
  RegionId back = kOutside;
};

/// Tetrahedra that fill the body inside the region of interest; faces conform to the interfaces.
/// Interface vertices come first, so surfaces and volumes deform together.
struct TetMesh {
  std::vector<Vec3> vertices;                            ///< (n_vertices), m, frame J
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  ///< (n_tets), positive orientation
  std::vector<RegionId> regions;                         ///< (n_tets)
  std::vector<Interface> interfaces;                     ///< (n_interfaces)
};

/// Signed volume of tetrahedron `i`, m^3; positive when well oriented.
[[nodiscard]] double tet_volume(const TetMesh& mesh, std::size_t i) noexcept;

/// The same over the cube of its longest edge: 0.118 of a regular one.
[[nodiscard]] double tet_compactness(const TetMesh& mesh, std::size_t i) noexcept;
/// Below this it is a sliver, which next to no motion turns over. assumed
inline constexpr double kSliver = 5e-3;

}  // namespace artus
