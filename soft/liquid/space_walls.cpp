// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/space_walls.h"

namespace artus {

std::vector<WallTriangle> walls_of(const TetMesh& mesh, const std::vector<bool>& regions) {
  const auto is_in = [&](RegionId r) {
    return r < regions.size() && regions[r];
  };
  std::vector<WallTriangle> walls;
  for (const Interface& f : mesh.interfaces) {
    const bool front = is_in(f.front);
    if (front == is_in(f.back)) continue;
    walls.push_back(front ? WallTriangle{f.vertices[0], f.vertices[2], f.vertices[1]} : f.vertices);
  }
  return walls;
}

double volume_within(std::span<const WallTriangle> walls, std::span<const Vec3> vertices,
                     const Vec3& from) noexcept {
  double six = 0;
  for (const auto& [a, b, c] : walls)
    six += (vertices[a] - from).dot((vertices[b] - from).cross(vertices[c] - from));
  return six / 6;
}

double volume_within(std::span<const WallTriangle> walls, std::span<const Vec3> vertices) noexcept {
  return volume_within(walls, vertices, vertices[walls.front()[0]]);
}

}  // namespace artus
