// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "artus/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// Distance to a triangle surface and whether a point is inside it, also where the surface has
/// holes, overlaps or crosses itself. Immutable after construction; safe to query from threads.
class DistanceTree {
 public:
  /// Cost: n log n. An empty mesh is everywhere infinitely far.
  explicit DistanceTree(const SurfaceMesh& mesh);

  /// Distance from `p` to the surface, m, or `bound` when it is not nearer than that. Cost: log n;
  /// a tight bound makes it cheaper.
  [[nodiscard]] double distance(const Vec3& p, double bound) const;

  /// Generalised winding number: 1 inside a closed outward surface, 0 outside, in between near
  /// holes. Far triangles are summed as dipoles. Cost: log n.
  /// Source: [Barill2018] eq. 4, first order, opening ratio 2.3.
  [[nodiscard]] double winding_number(const Vec3& p) const;

  [[nodiscard]] bool empty() const noexcept { return triangles_.empty(); }
  /// Corners of the bounding box; inverted when empty.
  [[nodiscard]] const Vec3& lower() const noexcept { return lower_; }
  [[nodiscard]] const Vec3& upper() const noexcept { return upper_; }

 private:
  struct Node {
    Vec3 lower, upper;
    Vec3 centre = Vec3::Zero();          // area weighted
    Vec3 dipole = Vec3::Zero();          // sum of area vectors
    double far2 = 0;                     // beyond this squared distance the dipole is good enough
    std::uint32_t first = 0, count = 0;  // leaf: triangles; inner: count 0, first = left child
  };
  struct FlatBox {  // of a node, rounded outward: two children share a cache line
    std::array<float, 3> lower, upper;
    std::uint32_t first = 0, count = 0;  // as in Node
  };
  using Corners = std::array<Vec3, 3>;

  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  void flatten();
  void summarise(Node& node, std::uint32_t first, std::uint32_t count) const;

  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
  std::vector<FlatBox> boxes_;  // (n_nodes)
  Vec3 lower_, upper_;
};

}  // namespace artus
