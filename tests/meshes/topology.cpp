// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/meshes/topology.h"

#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

namespace artus {

Topology compute_topology(const SurfaceMesh& mesh) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point> points;
  points.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  Topology topology;
  topology.manifold = pmp::is_polygon_soup_a_polygon_mesh(mesh.triangles);
  if (!topology.manifold) return topology;
  CGAL::Surface_mesh<Point> surface;
  pmp::polygon_soup_to_polygon_mesh(points, mesh.triangles, surface);
  topology.closed = CGAL::is_closed(surface);
  topology.outward = topology.closed && pmp::is_outward_oriented(surface);
  topology.self_intersecting = pmp::does_self_intersect(surface);
  return topology;
}

}  // namespace artus
