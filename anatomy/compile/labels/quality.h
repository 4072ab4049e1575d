// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>

#include "artus/detail/anatomy/body/tet_mesh.h"

namespace artus {

/// How well shaped tetrahedra are: what a deformation will need.
struct TetQuality {
  static constexpr double kBin = 5;         ///< deg, width of a histogram bin
  std::array<std::size_t, 15> histogram{};  ///< tetrahedra by their smallest dihedral angle
  double smallest_deg = 180;                ///< dihedral angle
  double largest_deg = 0;                   ///< dihedral angle
  std::size_t below_8_deg = 0;              ///< tetrahedra with a dihedral angle below 8 deg
  std::size_t inverted = 0;                 ///< tetrahedra without positive volume

  /// Share of tetrahedra whose dihedral angles are all at least 8 deg, percent.
  [[nodiscard]] double above_8_deg_percent() const noexcept;
};

/// Smallest and largest dihedral angle of a tetrahedron, deg.
[[nodiscard]] std::pair<double, double> dihedral_range_deg(const std::array<Vec3, 4>& corners);

/// Measures every tetrahedron. Cost: linear.
[[nodiscard]] TetQuality compute_quality(const TetMesh& mesh);

}  // namespace artus
