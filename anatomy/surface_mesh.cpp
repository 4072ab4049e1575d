// SPDX-License-Identifier: AGPL-3.0-or-later
#include "anatomy/surface_mesh.h"

#include <string>

namespace artus {

Result<SurfaceMesh> make_surface_mesh(std::span<const Vec3> vertices,
                                      std::span<const Triangle> triangles) {
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const auto v : triangles[i])
      if (v >= vertices.size())
        return fail(ErrorCode::malformed, "triangle " + std::to_string(i) + " names vertex " +
                                              std::to_string(v) + " of " +
                                              std::to_string(vertices.size()));
  return SurfaceMesh{{vertices.begin(), vertices.end()}, {triangles.begin(), triangles.end()}};
}

double signed_volume(const SurfaceMesh& mesh) noexcept {
  if (mesh.vertices.empty()) return 0;
  // Relative to a vertex of the mesh: far from the origin the products would cancel badly.
  const Vec3 o = mesh.vertices.front();
  double six_v = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - o;
    const Vec3 b = mesh.vertices[t[1]] - o;
    const Vec3 c = mesh.vertices[t[2]] - o;
    six_v += a.dot(b.cross(c));
  }
  return six_v / 6;
}

double surface_area(const SurfaceMesh& mesh) noexcept {
  double twice = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    twice += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
  }
  return twice / 2;
}

}  // namespace artus
