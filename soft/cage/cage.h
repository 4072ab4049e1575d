// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "artus/core/geometry.h"

namespace artus {

/// A box in which the cells of a cage are at most so large.
struct CageZone {
  Vec3 low = Vec3::Zero();   ///< m, frame C
  Vec3 high = Vec3::Zero();  ///< m
  double cell = 0;           ///< m
};

struct CageParams {
  Vec3 low = Vec3::Zero();   ///< m, corner of the box that is filled
  Vec3 high = Vec3::Zero();  ///< m, opposite corner; the last cells may reach beyond it
  double cell = 6e-3;        ///< m, coarsest cell
  std::vector<CageZone> zones;
};

/// A cube of the cage; nodes in the order x fastest, then y, then z.
struct CageCell {
  std::array<std::int32_t, 3> corner{};  ///< lattice position of its lowest corner
  std::int32_t span = 1;                 ///< edge in lattice steps, a power of two
  std::array<std::uint32_t, 8> nodes{};
};

/// A share of a node's displacement.
struct NodeShare {
  std::uint32_t node = 0;
  double weight = 0;
};

/// Where a point lies in the cage: displacement = sum of weight * displacement of the cell's node.
struct CagePlace {
  std::int32_t cell = -1;  ///< -1: outside the cage
  std::array<double, 8> weights{};
};

/// Cubes of halving size that fill a body, neighbours (over faces, edges and corners) at most twice
/// as large. A node in the middle of a larger neighbour's face or edge hangs: its displacement is
/// that of the face's or edge's nodes, so the displacement has no gaps. Frame C. Immutable.
class Cage {
 public:
  /// Fills the box; `keep` says of each cube (lowest corner, edge length) whether it belongs to the
  /// body. Requires: a box with volume, cells > 0, at most 2^26 lattice places
  /// (std::invalid_argument). Errors: none. Cost: about 0.1 s for 1e6 lattice places.
  Cage(const CageParams& params, const std::function<bool(const Vec3& low, double edge)>& keep);

  [[nodiscard]] std::span<const CageCell> cells() const noexcept { return cells_; }
  [[nodiscard]] std::span<const Vec3> nodes() const noexcept { return nodes_; }
  /// What a hanging node hangs on; empty for the others. Every share is of a node that does not
  /// hang.
  [[nodiscard]] std::span<const NodeShare> masters(std::uint32_t node) const noexcept {
    return std::span(shares_).subspan(share_start_[node],
                                      share_start_[node + 1] - share_start_[node]);
  }
  [[nodiscard]] double edge(const CageCell& cell) const noexcept { return cell.span * step_; }
  [[nodiscard]] Vec3 low_corner(const CageCell& cell) const noexcept;
  [[nodiscard]] double finest() const noexcept { return step_; }  ///< m, of the lattice

  /// The cell around a point; -1: none, or the point lies on the lattice's far side.
  [[nodiscard]] std::int32_t cell_around(const Vec3& p_C) const noexcept;
  /// The cell around a point with its trilinear weights; a point in no cell is given the nearest
  /// cell within `reach` lattice steps, with weights of the nearest point of that cell.
  [[nodiscard]] CagePlace locate(const Vec3& p_C, int reach = 0) const noexcept;

 private:
  using Lattice = std::array<std::int32_t, 3>;
  [[nodiscard]] std::size_t index(const Lattice& p) const noexcept;
  [[nodiscard]] bool inside(const Lattice& p) const noexcept;
  [[nodiscard]] std::int32_t leaf_at(const Lattice& p) const noexcept;
  [[nodiscard]] bool must_split(const CageCell& leaf,
                                std::span<const CageZone> zones) const noexcept;
  void fill(const CageCell& leaf, std::int32_t id) noexcept;
  void split(std::size_t leaf);
  void balance();
  void drop(const std::function<bool(const Vec3&, double)>& keep);
  void number_nodes();
  void hang_nodes();

  Vec3 origin_ = Vec3::Zero();
  double step_ = 0;
  Lattice size_{};                     // lattice places along each axis
  std::vector<std::int32_t> leaf_of_;  // (size_), x fastest; -1: none
  std::vector<CageCell> cells_;
  std::vector<Vec3> nodes_;
  std::vector<Lattice> node_places_;
  std::vector<std::uint32_t> share_start_;  // (n_nodes + 1)
  std::vector<NodeShare> shares_;
};

}  // namespace artus
