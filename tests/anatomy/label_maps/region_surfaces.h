// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"
#include "artus/detail/core/closest_point.h"

namespace artus::test {

/// A region's surface in a compiled joint, wound outward.
inline SurfaceMesh surface_of_region(const CompiledJoint& joint, RegionId region) {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> to(joint.mesh.vertices.size(), 0xffffffffU);
  for (const Interface& f : joint.mesh.interfaces) {
    if ((f.front == region) == (f.back == region)) continue;
    Triangle t = f.vertices;
    if (f.front == region) std::swap(t[1], t[2]);  // normals point from back to front
    for (std::uint32_t& v : t) {
      if (to[v] == 0xffffffffU) {
        to[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(joint.mesh.vertices[v]);
      }
      v = to[v];
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

inline double volume_of_region(const CompiledJoint& joint, RegionId region) {
  double volume = 0;
  for (std::size_t t = 0; t < joint.mesh.tetrahedra.size(); ++t)
    if (joint.mesh.regions[t] == region) volume += tet_volume(joint.mesh, t);
  return volume;
}

struct SurfaceDifference {
  double p95 = 0;         ///< m, from points of `got` to `truth`
  double normal_rms = 0;  ///< degrees, where `truth` is smooth
  std::size_t n_smooth = 0;
};

/// Points of `got` (the middles of its triangles, `n` of them about) against `truth`. Smooth is
/// what lies at a triangle whose neighbours are turned by less than `smooth` degrees.
inline SurfaceDifference compare(const SurfaceMesh& got, const SurfaceMesh& truth, std::size_t n,
                                 double smooth = 20) {
  std::vector<Vec3> normals;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> edges;
  for (std::size_t f = 0; f < truth.triangles.size(); ++f) {
    const Triangle& t = truth.triangles[f];
    const Vec3& a = truth.vertices[t[0]];
    normals.push_back((truth.vertices[t[1]] - a).cross(truth.vertices[t[2]] - a).normalized());
    for (std::size_t k = 0; k < 3; ++k) {
      const auto low_high = std::minmax(t[k], t[(k + 1) % 3]);
      edges[{low_high.first, low_high.second}].push_back(f);
    }
  }
  std::vector<bool> is_sharp(truth.triangles.size(), false);
  const double least_cosine = std::cos(smooth / 57.29577951308232);
  for (const auto& [edge, faces] : edges)
    for (const std::size_t f : faces)
      if (faces.size() != 2 || normals[faces[0]].dot(normals[faces[1]]) < least_cosine)
        is_sharp[f] = true;
  std::vector<double> distances;
  double squares = 0, area = 0;
  SurfaceDifference out;
  for (std::size_t f = 0; f < got.triangles.size(); f += got.triangles.size() / n + 1) {
    const Triangle& t = got.triangles[f];
    const Vec3& a = got.vertices[t[0]];
    const Vec3 p = (a + got.vertices[t[1]] + got.vertices[t[2]]) / 3;
    const Vec3 across = (got.vertices[t[1]] - a).cross(got.vertices[t[2]] - a);
    double least = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    for (std::size_t g = 0; g < truth.triangles.size(); ++g) {
      const Triangle& u = truth.triangles[g];
      const Vec3 q = closest_point_on_triangle(
          p, {truth.vertices[u[0]], truth.vertices[u[1]], truth.vertices[u[2]]});
      const double d = (q - p).squaredNorm();
      if (d < least) {
        least = d;
        nearest = g;
      }
    }
    distances.push_back(std::sqrt(least));
    if (is_sharp[nearest]) continue;
    const double angle =
        std::acos(std::clamp(across.normalized().dot(normals[nearest]), -1.0, 1.0));
    squares += across.norm() * angle * angle;
    area += across.norm();
    ++out.n_smooth;
  }
  std::sort(distances.begin(), distances.end());
  out.p95 = distances[static_cast<std::size_t>(0.95 * static_cast<double>(distances.size() - 1))];
  out.normal_rms = std::sqrt(squares / area) * 57.29577951308232;
  return out;
}

}  // namespace artus::test
