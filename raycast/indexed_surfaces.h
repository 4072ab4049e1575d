// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/detail/raycast/facet.h"

namespace artus {

/// What all indices of the same surfaces have in common: the surfaces as they are before anything
/// moves, and the blocks in which they may. Immutable once made; four tenths of an index.
struct IndexedSurfaces {
  /// Vertices that are moved together, in the order in which they are.
  using Group = std::span<const std::uint32_t>;

  /// `groups`: what may move; none: nothing does. Requires: indices in range, vertices finite,
  /// front and back of each interface differ; groups have vertices of interfaces alone, each at
  /// most once.
  IndexedSurfaces(std::span<const Vec3> from, std::span<const Interface> interfaces,
                  std::span<const Group> groups = {});

  using Corners = std::array<std::uint32_t, 3>;
  /// Interface of each triangle of each geometry.
  using Members = std::vector<std::vector<std::uint32_t>>;
  /// What one hierarchy is over, in one geometry or in one for each block.
  struct Part {
    Members members;
    std::vector<std::vector<Corners>> corners;  ///< of the members
  };

  Vec3 centre = Vec3::Zero();  ///< m, of the box around all interfaces
  double radius = 0;           ///< m, of a ball around it
  /// Relative to the centre: those up to the interfaces' last, group after group, so that a group
  /// moves in one piece; then those that never move.
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> begins;    ///< (groups + 1) of each group's, and of what never moves
  std::vector<Corners> triangles;       ///< (n_interfaces) of `vertices`
  std::vector<Facet> facets;            ///< (n_interfaces)
  std::vector<std::uint32_t> block_of;  ///< (n_interfaces), or empty: none moves
  std::vector<std::vector<std::uint32_t>> blocks_at;  ///< (groups) that have a triangle there
  std::vector<double> radii;                          ///< (groups, and what never moves) m
  std::size_t n_blocks = 0;
  Part all;
  Part boundary;  ///< outside or beyond on one side

  [[nodiscard]] bool can_move() const noexcept { return !block_of.empty(); }

 private:
  [[nodiscard]] std::vector<std::uint32_t> place_vertices(std::span<const Vec3> from,
                                                          std::span<const Group> groups);
  void make_blocks();
  [[nodiscard]] Part part_of(std::vector<std::uint32_t> interfaces) const;
};

/// The plane of a triangle, corners relative to the centre.
[[nodiscard]] FacetPlane plane_of(const std::array<Vec3, 3>& corners) noexcept;

/// Whether a region up to `last` is on one of the sides.
[[nodiscard]] constexpr bool touches(const FacetSides& sides, RegionId last) noexcept {
  return sides.front <= last || sides.back <= last;
}

}  // namespace artus
