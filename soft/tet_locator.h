// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "artus/anatomy/body/tet_mesh.h"

namespace artus {

/// Finds the tetrahedron around a point by a grid of boxes. Keeps a reference to the mesh.
class TetLocator {
 public:
  /// Requires: a mesh with tetrahedra (std::invalid_argument). Cost: about 0.5 s for 1e6.
  explicit TetLocator(const TetMesh& mesh, double box = 2e-3);

  /// Index of a tetrahedron that holds `p_J`, or -1. Cost: about 0.3 us.
  [[nodiscard]] std::int64_t find(const Vec3& p_J) const noexcept;

 private:
  [[nodiscard]] std::array<int, 3> box_of(const Vec3& p) const noexcept;
  [[nodiscard]] std::size_t index(int x, int y, int z) const noexcept;
  template <class Visit>
  void visit_boxes(std::size_t tet, Visit visit) const;

  const TetMesh& mesh_;
  double box_;
  Vec3 low_ = Vec3::Zero();
  std::array<int, 3> size_{};
  std::vector<std::uint32_t> start_;    // (n_boxes + 1)
  std::vector<std::uint32_t> members_;  // tetrahedra of each box, ascending
};

}  // namespace artus
