// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/body_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace artus {
namespace {

template <class F>
void for_each_ray(const RayGrid& grid, F visit) {
  const auto nx = static_cast<int>(grid.half_x / grid.spacing);
  const auto ny = static_cast<int>(grid.half_y / grid.spacing);
  for (int i = -nx; i <= nx; ++i)
    for (int j = -ny; j <= ny; ++j) {
      const Vec3 at(grid.spacing * i, grid.spacing * j, 0);
      visit(Segment{grid.X_JG * at, grid.X_JG * Vec3(at + grid.length * Vec3::UnitZ())});
    }
}

bool is_skin(const Interface& f) {
  return (f.front == kOutside) != (f.back == kOutside);
}

/// m^2, out of the body.
Vec3 outward_area(const TetMesh& mesh, const Interface& f) {
  const auto& [a, b, c] = f.vertices;
  const auto& p = mesh.vertices;
  const Vec3 area = (p[b] - p[a]).cross(p[c] - p[a]) / 2;
  return f.front == kOutside ? area : Vec3(-area);
}

/// m^3 between the skin and `centre`.
double volume_below_skin(const TetMesh& mesh, const Vec3& centre) {
  double volume = 0;
  for (const Interface& f : mesh.interfaces)
    if (is_skin(f))
      volume += (mesh.vertices[f.vertices[0]] - centre).dot(outward_area(mesh, f)) / 3;
  return volume;
}

bool has_same_skin(const TetMesh& a, const TetMesh& b) {
  auto g = b.interfaces.begin();
  const auto next = [&] {
    return g = std::find_if(g, b.interfaces.end(), is_skin);
  };
  for (const Interface& f : a.interfaces) {
    if (!is_skin(f)) continue;
    if (next() == b.interfaces.end() || g->vertices != f.vertices) return false;
    ++g;
  }
  return next() == b.interfaces.end();
}

}  // namespace

LeastRatio find_least_ratio(const TetMesh& rest, const TetMesh& now,
                            const std::vector<bool>& liquid) {
  LeastRatio least;
  const bool same =
      rest.vertices.size() == now.vertices.size() && rest.tetrahedra == now.tetrahedra;
  if (!same) return least;
  for (std::size_t i = 0; i < rest.tetrahedra.size(); ++i) {
    const RegionId region = rest.regions[i];
    if (region < liquid.size() && liquid[region]) continue;
    if (!(tet_compactness(rest, i) > kSliver)) continue;
    ++least.compared;
    const double ratio = tet_volume(now, i) / tet_volume(rest, i);
    if (!(ratio > 0)) least.inverted.push_back(i);
    if (ratio >= least.ratio) continue;
    least.ratio = ratio;
    least.region = rest.regions[i];
    least.p_J = Vec3::Zero();
    for (const std::uint32_t v : rest.tetrahedra[i]) least.p_J += rest.vertices[v] / 4;
  }
  return least;
}

bool is_tissue_inverted(const DeformedBody& body, std::size_t tetrahedron) {
  const TetMesh& mesh = body.joint().mesh;
  if (!(tet_volume(mesh, tetrahedron) > 0)) return true;
  const auto inverts = [&](const Vec3& p) {
    return !(body.motion(p).gradient.determinant() > 0);
  };
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t v : mesh.tetrahedra[tetrahedron]) middle += mesh.vertices[v] / 4;
  bool inverted = inverts(middle);
  for (const std::uint32_t v : mesh.tetrahedra[tetrahedron])
    for (const double share : {0.25, 0.5, 0.75})
      inverted = inverted || inverts(middle + share * (mesh.vertices[v] - middle));
  return inverted;
}

std::size_t count_not_finite(std::span<const Vec3> points) {
  return static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(), [](const Vec3& p) { return !p.allFinite(); }));
}

CompiledJoint body_in(const Scene& scene) {
  return scene.tissue() ? scene.tissue()->moved_joint() : scene.joint();
}

std::vector<bool> regions_named(const CompiledJoint& joint, std::span<const std::string> names) {
  std::vector<bool> named;
  for (const Region& r : joint.regions)
    named.push_back(std::find(names.begin(), names.end(), r.name) != names.end());
  return named;
}

RayGrid grid_around(std::span<const Vec3> points, const Eigen::Matrix3d& axes, std::size_t rays) {
  constexpr double kMargin = 2e-3;    // m
  constexpr double kFinest = 0.2e-3;  // m
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (const Vec3& p : points) {
    const Vec3 q = axes.transpose() * p;
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  low.array() -= kMargin;
  high.array() += kMargin;
  const Vec3 size = high - low;
  RayGrid grid;
  grid.X_JG.linear() = axes;
  grid.X_JG.translation() =
      axes * Vec3((low.x() + high.x()) / 2, (low.y() + high.y()) / 2, low.z());
  grid.half_x = size.x() / 2;
  grid.half_y = size.y() / 2;
  grid.length = size.z();
  grid.spacing = std::max(kFinest, std::sqrt(size.x() * size.y() / static_cast<double>(rays)));
  return grid;
}

std::vector<Vec3> points_of(const CompiledJoint& joint, const std::vector<bool>& regions) {
  std::vector<Vec3> points;
  for (const Interface& f : joint.mesh.interfaces)
    if (regions[f.front] || regions[f.back])
      for (const std::uint32_t v : f.vertices) points.push_back(joint.mesh.vertices[v]);
  return points;
}

double volume_along(const Scene& scene, const RayGrid& grid, const std::vector<bool>& regions) {
  std::array<TissueInterval, 128> intervals;
  double length = 0;
  for_each_ray(grid, [&](const Segment& ray) {
    const QueryCount count = scene.find_intervals(ray, intervals);
    for (std::size_t k = 0; k < count.size; ++k)
      if (regions[intervals[k].region]) length += intervals[k].exit - intervals[k].entry;
  });
  return length * grid.spacing * grid.spacing;
}

SkinLift find_skin_lift(const TetMesh& before, const TetMesh& after, const Vec3& centre) {
  SkinLift out;
  out.net = volume_below_skin(after, centre) - volume_below_skin(before, centre);
  out.lifted = out.net;
  if (!has_same_skin(before, after)) return out;
  out.lifted = 0;
  for (const Interface& f : before.interfaces) {
    if (!is_skin(f)) continue;
    const Vec3 area = (outward_area(before, f) + outward_area(after, f)) / 2;
    for (const std::uint32_t v : f.vertices) {
      const Vec3 moved = after.vertices[v] - before.vertices[v];
      out.lifted += std::max(0.0, moved.dot(area)) / 3;
      const double height = area.norm() > 0 ? moved.dot(area.normalized()) : 0;
      if (height <= out.highest) continue;
      out.highest = height;
      out.p_J = before.vertices[v];
    }
  }
  return out;
}

}  // namespace artus
