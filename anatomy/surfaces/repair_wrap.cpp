// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/anatomy/surfaces/repair_steps.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"

namespace artus {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using CgalMesh = CGAL::Surface_mesh<Point>;

std::vector<Point> points_of(const SurfaceMesh& mesh) {
  std::vector<Point> points;
  points.reserve(mesh.vertices.size());
  for (const Vec3& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  return points;
}

std::vector<std::array<std::size_t, 3>> faces_of(const SurfaceMesh& mesh) {
  std::vector<std::array<std::size_t, 3>> faces;
  faces.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) faces.push_back({t[0], t[1], t[2]});
  return faces;
}

CgalMesh to_cgal(const SurfaceMesh& mesh) {
  CgalMesh out;
  pmp::polygon_soup_to_polygon_mesh(points_of(mesh), faces_of(mesh), out);
  return out;
}

SurfaceMesh from_cgal(CgalMesh& mesh) {
  mesh.collect_garbage();
  SurfaceMesh out;
  for (const auto v : mesh.vertices()) {
    const Point& p = mesh.point(v);
    out.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : mesh.faces()) {
    Triangle t{};
    std::size_t k = 0;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh))
      t[k++] = static_cast<std::uint32_t>(v);
    out.triangles.push_back(t);
  }
  return out;
}

/// Nearest points of a surface, taken as a soup: each triangle by itself.
class NearestPoint {
 public:
  explicit NearestPoint(const SurfaceMesh& mesh) {
    for (const auto& t : mesh.triangles) {
      std::array<CgalMesh::Vertex_index, 3> v;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = mesh.vertices[t[k]];
        v[k] = target_.add_vertex(Point(p.x(), p.y(), p.z()));
      }
      target_.add_face(v[0], v[1], v[2]);
    }
    tree_.emplace(target_.faces().begin(), target_.faces().end(), target_);
  }
  [[nodiscard]] Vec3 operator()(const Vec3& p) const {
    const Point q = tree_->closest_point(Point(p.x(), p.y(), p.z()));
    return {q.x(), q.y(), q.z()};
  }

 private:
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<CgalMesh>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
  CgalMesh target_;
  std::optional<Tree> tree_;
};

Vec3 area_vector(const SurfaceMesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[1]] - mesh.vertices[t[0]])
      .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}

/// The faces of `moved` that turned over against `start` or cross others.
std::vector<std::size_t> find_spoilt(const SurfaceMesh& start, const SurfaceMesh& moved) {
  constexpr double kTurned = 0.5;  // cosine
  std::vector<std::size_t> spoilt;
  for (std::size_t f = 0; f < moved.triangles.size(); ++f) {
    const Vec3 was = area_vector(start, start.triangles[f]);
    const Vec3 is = area_vector(moved, moved.triangles[f]);
    if (!(was.dot(is) > kTurned * was.norm() * is.norm())) spoilt.push_back(f);
  }
  for (const auto& [a, b] : find_self_intersections(moved)) {
    spoilt.push_back(a);
    spoilt.push_back(b);
  }
  return spoilt;
}

/// Lays the wrap onto the surface it was made around; where that spoils a face its vertices go
/// half as far, and back to where they were in the last round.
void lay_onto(SurfaceMesh& wrap, const SurfaceMesh& surface) {
  constexpr double kFull = 0.95;  // of the way: two walls of a thin part must stay apart
  constexpr int kMaxRounds = 8;
  const NearestPoint nearest(surface);
  const SurfaceMesh start = wrap;
  std::vector<double> share(wrap.vertices.size(), kFull);
  std::vector<Vec3> path(wrap.vertices.size());
  for (std::size_t v = 0; v < path.size(); ++v)
    path[v] = nearest(start.vertices[v]) - start.vertices[v];
  for (int round = 0; round <= kMaxRounds; ++round) {
    for (std::size_t v = 0; v < path.size(); ++v)
      wrap.vertices[v] = start.vertices[v] + share[v] * path[v];
    const auto spoilt = find_spoilt(start, wrap);
    if (spoilt.empty()) return;
    std::vector<bool> is_spoilt(path.size(), false);
    for (const std::size_t f : spoilt)
      for (const auto v : wrap.triangles[f]) is_spoilt[v] = true;
    for (std::size_t v = 0; v < path.size(); ++v)
      if (is_spoilt[v]) share[v] = round < kMaxRounds - 1 ? share[v] / 2 : 0;
  }
  wrap = start;
}

}  // namespace

bool untangle(SurfaceMesh& mesh) {
  constexpr double kVolumeChange = 0.01;
  try {
    if (!pmp::is_polygon_soup_a_polygon_mesh(faces_of(mesh))) return false;
    CgalMesh cgal = to_cgal(mesh);
    CGAL::get_default_random() = CGAL::Random(0);  // of this thread, whatever it did before
    pmp::experimental::remove_self_intersections(cgal);
    const SurfaceMesh after = from_cgal(cgal);
    const auto edges = count_edges(after);
    const double before = signed_volume(mesh);
    if (after.triangles.empty() || edges.open > 0 || edges.non_manifold > 0 ||
        std::abs(signed_volume(after) - before) > kVolumeChange * std::abs(before) ||
        !find_self_intersections(after, 1).empty())
      return false;
    mesh = after;
    return true;
  } catch (const std::exception&) {  // a failed CGAL precondition: the mesh stays as it was
    return false;
  }
}

Result<SurfaceMesh> make_wrap(const SurfaceMesh& mesh, double detail, double offset,
                              WrapPlace place) {
  try {
    CgalMesh wrap;
    CGAL::alpha_wrap_3(points_of(mesh), faces_of(mesh), detail, offset, wrap);
    SurfaceMesh out = from_cgal(wrap);
    if (out.triangles.empty()) return fail(ErrorCode::failed, "the wrap is empty");
    if (place == WrapPlace::on_surface) lay_onto(out, mesh);
    return out;
  } catch (const std::exception& error) {
    return fail(ErrorCode::failed, std::string("the surface cannot be wrapped: ") + error.what());
  }
}

}  // namespace artus
