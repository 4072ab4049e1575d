// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "artus/core/geometry.h"

namespace artus {

/// How near bone lies around a point, by direction. Lengths are in a unit of the caller's choice.
/// Directions are the nodes of a square that an octahedron unfolds to; between them it is
/// continuous. Nowhere is bone nearer than it says; beside a bone's edge it says nearer, falling
/// off over some ten degrees, so that nothing that follows it has a step.
class BoneShadow {
 public:
  /// Bone farther than this is not seen.
  static constexpr double kFarthest = 8;

  BoneShadow();
  /// One of bone's triangles, its corners as seen from the point. Call `spread` after the last.
  void add(const std::array<Vec3, 3>& triangle);
  void spread();

  /// 1 / d^3, where d is how far bone leaves the direction `y` (of any length above 0) free; 0: as
  /// far as is seen. Cost: some ns.
  [[nodiscard]] double nearness(const Vec3& y) const;

 private:
  static constexpr int kNodes = 49;  // along each side

  [[nodiscard]] double& node(int i, int j);
  void mark(const Vec3& point, double nearness);
  void add_part(const std::array<Vec3, 3>& triangle, int depth);
  void close_seams();

  std::vector<double> nodes_;
};

}  // namespace artus
