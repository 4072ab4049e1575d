// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "artus/detail/anatomy/body/tet_mesh.h"

namespace artus {

/// Finds the tetrahedron around a point by a grid of boxes. Keeps a reference to the mesh, and some
/// 50 bytes a tetrahedron.
class TetLocator {
 public:
  /// Requires: a mesh with tetrahedra (std::invalid_argument). Cost: about 0.5 s for 1e6.
  explicit TetLocator(const TetMesh& mesh, double box = 2e-3);

  /// Index of a tetrahedron that holds `p_J`, or -1. Cost: about 0.2 us.
  [[nodiscard]] std::int64_t find(const Vec3& p_J) const noexcept;

 private:
  /// Steps of a box's side that a tetrahedron's extent within it spans, from 0 to 255.
  struct Extent {
    std::array<std::uint8_t, 3> low{};
    std::array<std::uint8_t, 3> high{};
  };
  [[nodiscard]] std::array<int, 3> box_of(const Vec3& p) const noexcept;
  [[nodiscard]] std::array<std::uint8_t, 3> steps_in(const std::array<int, 3>& box,
                                                     const Vec3& p) const noexcept;
  [[nodiscard]] bool holds(std::uint32_t tet, const Vec3& p) const noexcept;
  [[nodiscard]] std::size_t index(const std::array<int, 3>& box) const noexcept;
  template <class Visit>
  void visit_boxes(const std::array<Vec3, 2>& extent, Visit visit) const;

  const TetMesh& mesh_;
  double per_metre_;  // boxes
  Vec3 low_ = Vec3::Zero();
  std::array<int, 3> size_{};
  std::vector<std::uint32_t> start_;    // (n_boxes + 1)
  std::vector<std::uint32_t> members_;  // tetrahedra of each box, ascending
  std::vector<Extent> extents_;         // (members): all but a few are left without their corners
};

}  // namespace artus
