// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/repair_rims.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace artus {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Flat = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_tag>;
using PlanePoint = Kernel::Point_2;

constexpr double kPlanar = 0.01;  // radii
constexpr double kJagged = 0.25;  // radii
constexpr int kUnknown = -1;

/// Coordinates in a plane, so that a rim around `normal` runs counter-clockwise.
struct View {
  Vec3 u, v;
  explicit View(const Vec3& normal) : u(normal.unitOrthogonal()), v(normal.cross(u)) {}
  [[nodiscard]] PlanePoint operator()(const Vec3& p) const { return {p.dot(u), p.dot(v)}; }
};

bool is_inside(const SurfaceMesh& mesh, const Rim& rim, const View& view, const Vec3& p) {
  const PlanePoint q = view(p);
  bool inside = false;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const PlanePoint a = view(mesh.vertices[rim[k]]);
    const PlanePoint b = view(mesh.vertices[rim[(k + 1) % rim.size()]]);
    if ((a.y() > q.y()) == (b.y() > q.y())) continue;
    const double x = a.x() + (q.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (q.x() < x) inside = !inside;
  }
  return inside;
}

/// Inserts points and rims; false when two points are one or two sides cross.
bool insert(const SurfaceMesh& mesh, const std::vector<Rim>& rims, const Rim& inner,
            const View& view, Flat& flat) {
  std::size_t n = 0;
  try {
    for (const Rim& rim : rims) {
      std::vector<Flat::Vertex_handle> handles;
      for (const auto v : rim) {
        handles.push_back(flat.insert(view(mesh.vertices[v])));
        handles.back()->info() = v;
        ++n;
      }
      if (flat.number_of_vertices() != n) return false;
      for (std::size_t k = 0; k < rim.size(); ++k)
        flat.insert_constraint(handles[k], handles[(k + 1) % rim.size()]);
    }
    for (const auto v : inner) {
      flat.insert(view(mesh.vertices[v]))->info() = v;
      ++n;
    }
  } catch (const Flat::Intersection_of_constraints_exception&) {
    return false;
  }
  return flat.number_of_vertices() == n;
}

/// Numbers the faces by how many rims lie around them.
void count_rims_around(Flat& flat) {
  for (const auto f : flat.all_face_handles()) f->info() = kUnknown;
  std::queue<Flat::Face_handle> next;
  std::queue<std::pair<Flat::Face_handle, int>> beyond;
  beyond.emplace(flat.infinite_face(), 0);
  while (!beyond.empty()) {
    const auto [start, depth] = beyond.front();
    beyond.pop();
    if (start->info() != kUnknown) continue;
    start->info() = depth;
    next.push(start);
    while (!next.empty()) {
      const auto f = next.front();
      next.pop();
      for (int k = 0; k < 3; ++k) {
        const auto other = f->neighbor(k);
        if (other->info() != kUnknown) continue;
        if (f->is_constrained(k)) {
          beyond.emplace(other, depth + 1);
        } else {
          other->info() = depth;
          next.push(other);
        }
      }
    }
  }
}

std::vector<Triangle> take_patch(Flat& flat) {
  count_rims_around(flat);
  std::vector<Triangle> patch;
  for (const auto f : flat.finite_face_handles())
    if (f->info() % 2 == 1)
      patch.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  std::sort(patch.begin(), patch.end());
  return patch;
}

using Side = std::pair<std::uint32_t, std::uint32_t>;

Side side_of(std::uint32_t a, std::uint32_t b) {
  return std::minmax(a, b);
}

std::vector<Side> rim_sides(const std::vector<Rim>& rims) {
  std::vector<Side> sides;
  for (const Rim& rim : rims)
    for (std::size_t k = 0; k < rim.size(); ++k)
      sides.push_back(side_of(rim[k], rim[(k + 1) % rim.size()]));
  std::sort(sides.begin(), sides.end());
  return sides;
}

std::vector<Side> crowded_sides(const std::vector<EdgeUse>& uses,
                                const std::vector<Triangle>& patch, const std::vector<Side>& rim) {
  std::vector<Side> crowded;
  for (const auto& t : patch)
    for (std::size_t k = 0; k < 3; ++k) {
      const Side side = side_of(t[k], t[(k + 1) % 3]);
      if (!std::binary_search(rim.begin(), rim.end(), side) &&
          has_edge(uses, side.first, side.second))
        crowded.push_back(side);
    }
  std::sort(crowded.begin(), crowded.end());
  crowded.erase(std::unique(crowded.begin(), crowded.end()), crowded.end());
  return crowded;
}

}  // namespace

bool RimShape::is_planar() const noexcept {
  return bend <= kPlanar;
}

bool RimShape::is_jagged() const noexcept {
  return bend <= kJagged;
}

double RimShape::roundness() const noexcept {
  return perimeter > 0 ? 4 * std::numbers::pi * area / (perimeter * perimeter) : 0;
}

double RimShape::width() const noexcept {
  return perimeter > 0 ? 2 * area / perimeter : 0;
}

RimShape measure_rim(const SurfaceMesh& mesh, const Rim& rim) {
  RimShape shape;
  for (const auto v : rim) shape.centre += mesh.vertices[v];
  shape.centre /= static_cast<double>(rim.size());
  Vec3 twice_area = Vec3::Zero();
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const Vec3 a = mesh.vertices[rim[k]] - shape.centre;
    const Vec3 b = mesh.vertices[rim[(k + 1) % rim.size()]] - shape.centre;
    twice_area += a.cross(b);
    shape.perimeter += (b - a).norm();
    shape.radius += a.norm() / static_cast<double>(rim.size());
  }
  shape.normal = twice_area.stableNormalized();
  shape.area = twice_area.norm() / 2;
  for (const auto v : rim)
    shape.bend = std::max(shape.bend, std::abs(shape.normal.dot(mesh.vertices[v] - shape.centre)));
  shape.bend = shape.radius > 0 && shape.area > 0 ? shape.bend / shape.radius : 1;
  return shape;
}

bool is_hole_in(const SurfaceMesh& mesh, const Rim& inner, const RimShape& inner_shape,
                const Rim& outer, const RimShape& outer_shape) {
  constexpr double kParallel = 0.9;  // cosine
  if (inner_shape.area >= outer_shape.area ||
      inner_shape.normal.dot(outer_shape.normal) > -kParallel)
    return false;
  const double off = std::abs(outer_shape.normal.dot(inner_shape.centre - outer_shape.centre));
  const double most = outer_shape.is_planar() ? kPlanar : kJagged;
  return off <= most * outer_shape.radius &&
         is_inside(mesh, outer, View(outer_shape.normal), mesh.vertices[inner.front()]);
}

std::vector<Triangle> triangulate_flat(SurfaceMesh& mesh, const std::vector<EdgeUse>& uses,
                                       const std::vector<Rim>& rims, const Vec3& normal,
                                       Rim inner) {
  constexpr int kMaxRounds = 8;
  const View view(normal);
  const auto sides = rim_sides(rims);
  const std::size_t n_vertices = mesh.vertices.size();
  for (int round = 0; round < kMaxRounds; ++round) {
    Flat flat;
    if (!insert(mesh, rims, inner, view, flat)) break;
    auto patch = take_patch(flat);
    const auto crowded = crowded_sides(uses, patch, sides);
    if (crowded.empty() && !patch.empty()) return patch;
    if (patch.empty()) break;
    for (const Side& side : crowded) {
      inner.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      const Vec3 middle = (mesh.vertices[side.first] + mesh.vertices[side.second]) / 2;
      mesh.vertices.push_back(middle);
    }
  }
  mesh.vertices.resize(n_vertices);
  return {};
}

bool has_edge(const std::vector<EdgeUse>& uses, std::uint32_t a, std::uint32_t b) {
  const Side key = side_of(a, b);
  const auto it =
      std::lower_bound(uses.begin(), uses.end(), key,
                       [](const EdgeUse& u, const Side& k) { return Side(u.lo, u.hi) < k; });
  return it != uses.end() && it->lo == key.first && it->hi == key.second;
}

bool crowds_an_edge(const std::vector<EdgeUse>& uses, const std::vector<Triangle>& patch,
                    const Rim& rim) {
  return !crowded_sides(uses, patch, rim_sides({rim})).empty();
}

}  // namespace artus
