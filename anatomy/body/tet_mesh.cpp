// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/tet_mesh.h"

#include <algorithm>

namespace artus {

double tet_volume(const TetMesh& mesh, std::size_t i) noexcept {
  const auto& t = mesh.tetrahedra[i];
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).dot(mesh.vertices[t[3]] - a) / 6;
}

double tet_compactness(const TetMesh& mesh, std::size_t i) noexcept {
  double longest = 0;
  for (const std::uint32_t a : mesh.tetrahedra[i])
    for (const std::uint32_t b : mesh.tetrahedra[i])
      longest = std::max(longest, (mesh.vertices[a] - mesh.vertices[b]).norm());
  return tet_volume(mesh, i) / (longest * longest * longest);
}

}  // namespace artus
