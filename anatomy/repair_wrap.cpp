// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include "anatomy/defects.h"
#include "anatomy/repair_steps.h"
#include "anatomy/surface_topology.h"

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

}  // namespace

bool untangle(SurfaceMesh& mesh) {
  constexpr double kVolumeChange = 0.01;
  try {
    if (!pmp::is_polygon_soup_a_polygon_mesh(faces_of(mesh))) return false;
    CgalMesh cgal = to_cgal(mesh);
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

Result<SurfaceMesh> make_wrap(const SurfaceMesh& mesh, double detail, double offset) {
  try {
    CgalMesh wrap;
    CGAL::alpha_wrap_3(points_of(mesh), faces_of(mesh), detail, offset, wrap);
    SurfaceMesh out = from_cgal(wrap);
    if (out.triangles.empty()) return fail(ErrorCode::failed, "the wrap is empty");
    return out;
  } catch (const std::exception& error) {
    return fail(ErrorCode::failed, std::string("the surface cannot be wrapped: ") + error.what());
  }
}

double largest_distance(const SurfaceMesh& a, const SurfaceMesh& b) {
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<CgalMesh>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
  CgalMesh target;
  std::vector<CgalMesh::Vertex_index> vertices;
  for (const auto& t : b.triangles) {  // a soup: each triangle by itself, whatever its neighbours
    std::array<CgalMesh::Vertex_index, 3> v;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = b.vertices[t[k]];
      v[k] = target.add_vertex(Point(p.x(), p.y(), p.z()));
    }
    target.add_face(v[0], v[1], v[2]);
  }
  Tree tree(target.faces().begin(), target.faces().end(), target);
  double largest = 0;
  for (const Vec3& p : a.vertices)
    largest = std::max(largest, tree.squared_distance(Point(p.x(), p.y(), p.z())));
  return std::sqrt(largest);
}

}  // namespace artus
