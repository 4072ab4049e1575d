// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/tet_mesh.h"

namespace artus {

double tet_volume(const TetMesh& mesh, std::size_t i) noexcept {
  const auto& t = mesh.tetrahedra[i];
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).dot(mesh.vertices[t[3]] - a) / 6;
}

}  // namespace artus
