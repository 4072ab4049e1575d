// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/raycast/facet.h"

namespace artus {

/// Which vertices are moved together.
struct VertexGrouping {
  std::span<const std::uint32_t> of;  ///< the first vertices' groups; `n` and more: never moved
  std::uint32_t n = 0;                ///< groups; 0: nothing moves
};

/// What all indices of the same surfaces have in common: the surfaces as they are before anything
/// moves, and the blocks in which they may. Immutable once made; four tenths of an index.
struct IndexedSurfaces {
  /// Requires: indices in range, vertices finite, front and back of each interface differ.
  IndexedSurfaces(std::span<const Vec3> from, std::span<const Interface> interfaces,
                  const VertexGrouping& groups);

  using Corners = std::array<std::uint32_t, 3>;
  /// Interface of each triangle of each geometry.
  using Members = std::vector<std::vector<std::uint32_t>>;
  /// What one hierarchy is over, in one geometry or in one for each block.
  struct Part {
    Members members;
    std::vector<std::vector<Corners>> corners;  ///< of the members
  };

  Vec3 centre = Vec3::Zero();      ///< m, of the box around all interfaces
  double radius = 0;               ///< m, of a ball around it
  std::vector<Vec3> vertices;      ///< relative to the centre; those up to the interfaces' last
  std::vector<Corners> triangles;  ///< (n_interfaces)
  std::vector<Facet> facets;       ///< (n_interfaces)
  std::vector<std::uint32_t> block_of;                ///< (n_interfaces), or empty: none moves
  std::vector<std::vector<std::uint32_t>> blocks_at;  ///< (groups) that have a triangle there
  std::vector<double> radii;                          ///< (groups, and what never moves) m
  std::size_t n_blocks = 0;
  Part all;
  Part boundary;  ///< outside or beyond on one side

  [[nodiscard]] bool can_move() const noexcept { return !block_of.empty(); }

 private:
  void make_blocks(const VertexGrouping& groups);
  [[nodiscard]] Part part_of(std::vector<std::uint32_t> interfaces) const;
};

/// The plane of a triangle, corners relative to the centre.
[[nodiscard]] FacetPlane plane_of(const std::array<Vec3, 3>& corners) noexcept;

/// Whether a region up to `last` is on one of the sides.
[[nodiscard]] constexpr bool touches(const FacetSides& sides, RegionId last) noexcept {
  return sides.front <= last || sides.back <= last;
}

}  // namespace artus
