// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
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
  double normal_rms = 0;  ///< degrees, where `truth` is smooth, between normals of the surfaces
  double facet_rms = 0;   ///< the same between normals of facets: their coarseness counts
  std::size_t n_smooth = 0;
};

/// A surface whose facets stand for a smooth one: normals run from corner to corner, save over
/// edges.
class FacetedSurface {
 public:
  /// An edge is where neighbours are turned by more than `smooth` degrees.
  FacetedSurface(const SurfaceMesh& mesh, double smooth) : mesh_(mesh) {
    constexpr double kRadian = 57.29577951308232;  // degrees
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> sides;
    std::vector<std::vector<std::size_t>> around(mesh.vertices.size());
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      const Triangle& t = mesh.triangles[f];
      across_.push_back((mesh.vertices[t[1]] - mesh.vertices[t[0]])
                            .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]));
      normals_.push_back(across_.back().normalized());
      for (std::size_t k = 0; k < 3; ++k) {
        const auto low_high = std::minmax(t[k], t[(k + 1) % 3]);
        sides[{low_high.first, low_high.second}].push_back(f);
        around[t[k]].push_back(f);
      }
    }
    is_sharp_.assign(normals_.size(), false);
    for (const auto& [ends, faces] : sides) {
      if (faces.size() == 2 &&
          normals_[faces[0]].dot(normals_[faces[1]]) >= std::cos(smooth / kRadian))
        continue;
      edges_.push_back({mesh.vertices[ends.first], mesh.vertices[ends.second]});
      for (const std::size_t f : faces) is_sharp_[f] = true;
    }
    make_corners(around);
  }

  [[nodiscard]] const Vec3& facet_normal(std::size_t f) const { return normals_[f]; }
  [[nodiscard]] double area(std::size_t f) const { return across_[f].norm() / 2; }
  [[nodiscard]] std::array<Vec3, 3> corners(std::size_t f) const {
    const Triangle& t = mesh_.triangles[f];
    return {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
  }
  /// Between the corners of facet `f`, at its point `p`.
  [[nodiscard]] Vec3 normal(std::size_t f, const Vec3& p) const {
    const auto c = corners(f);
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      sum += (c[(k + 1) % 3] - p).cross(c[(k + 2) % 3] - p).norm() * corner_normals_[f][k];
    return sum.normalized();
  }
  /// The facet nearest to `p` and its nearest point.
  [[nodiscard]] std::pair<std::size_t, Vec3> nearest(const Vec3& p) const {
    std::pair<std::size_t, Vec3> found{0, p};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t f = 0; f < normals_.size(); ++f) {
      const Vec3 q = closest_point_on_triangle(p, corners(f));
      const double d = (q - p).squaredNorm();
      if (d < least) {
        least = d;
        found = {f, q};
      }
    }
    return found;
  }
  /// Whether it is smooth at a point of facet `f`: no edge of it, nor another one within `near`.
  [[nodiscard]] bool is_smooth(std::size_t f, const Vec3& p, double near) const {
    return !is_sharp_[f] && std::none_of(edges_.begin(), edges_.end(), [&](const auto& edge) {
      const Vec3 along = edge[1] - edge[0];
      const double s = std::clamp((p - edge[0]).dot(along) / along.squaredNorm(), 0.0, 1.0);
      return (edge[0] + s * along - p).squaredNorm() < near * near;
    });
  }

 private:
  // Of the facets around a corner those that are turned by less than 45 degrees count (assumed: a
  // tube of 5 mm has facets of 2.5 mm), by their areas.
  void make_corners(const std::vector<std::vector<std::size_t>>& around) {
    constexpr double kCrease = 0.7071;  // cosine
    for (std::size_t f = 0; f < normals_.size(); ++f) {
      auto& corners = corner_normals_.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3 sum = Vec3::Zero();
        for (const std::size_t g : around[mesh_.triangles[f][k]])
          if (normals_[g].dot(normals_[f]) > kCrease) sum += across_[g];
        corners[k] = sum.norm() > 0 ? Vec3(sum.normalized()) : normals_[f];
      }
    }
  }

  const SurfaceMesh& mesh_;
  std::vector<Vec3> across_, normals_;
  std::vector<std::array<Vec3, 3>> corner_normals_;
  std::vector<std::array<Vec3, 2>> edges_;
  std::vector<bool> is_sharp_;
};

/// Points of `got` (the middles of its triangles, `n` of them about) against `truth`. Smooth is
/// what lies at a triangle whose neighbours are turned by less than 20 degrees, and no less than
/// `voxel` (m) away from where they are turned by more: a label map knows no better where an edge
/// lies.
inline SurfaceDifference compare(const SurfaceMesh& got, const SurfaceMesh& truth, std::size_t n,
                                 double voxel) {
  constexpr double kSmooth = 20;  // degrees
  const FacetedSurface mine(got, kSmooth);
  const FacetedSurface theirs(truth, kSmooth);
  const auto square = [](const Vec3& a, const Vec3& b) {
    const double angle = std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 57.29577951308232;
    return angle * angle;
  };
  std::vector<double> distances;
  double squares = 0, facet_squares = 0, area = 0;
  SurfaceDifference out;
  for (std::size_t f = 0; f < got.triangles.size(); f += got.triangles.size() / n + 1) {
    const auto c = mine.corners(f);
    const Vec3 p = (c[0] + c[1] + c[2]) / 3;
    const auto [nearest, q] = theirs.nearest(p);
    distances.push_back((q - p).norm());
    if (!theirs.is_smooth(nearest, q, voxel)) continue;
    const double weight = mine.area(f);
    squares += weight * square(mine.normal(f, p), theirs.normal(nearest, q));
    facet_squares += weight * square(mine.facet_normal(f), theirs.facet_normal(nearest));
    area += weight;
    ++out.n_smooth;
  }
  std::sort(distances.begin(), distances.end());
  out.p95 = distances[static_cast<std::size_t>(0.95 * static_cast<double>(distances.size() - 1))];
  if (area > 0) {
    out.normal_rms = std::sqrt(squares / area);
    out.facet_rms = std::sqrt(facet_squares / area);
  }
  return out;
}

}  // namespace artus::test
