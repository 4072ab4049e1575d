// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

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

double triangle_area(const SurfaceMesh& mesh, const Triangle& t) noexcept {
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm() / 2;
}

Vec3 triangle_centre(const SurfaceMesh& mesh, const Triangle& t) noexcept {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

double surface_area(const SurfaceMesh& mesh) noexcept {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += triangle_area(mesh, t);
  return area;
}

}  // namespace artus
