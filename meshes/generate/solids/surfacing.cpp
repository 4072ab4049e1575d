// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/solids/surfacing.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <CGAL/Complex_2_in_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_with_circumcenter_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/facets_in_complex_2_to_triangle_mesh.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Random.h>
#include <CGAL/Robust_circumcenter_traits_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_cell_base_3.h>
#include <CGAL/Surface_mesh_default_criteria_3.h>
#include <CGAL/Surface_mesh_vertex_base_3.h>
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/make_surface_mesh.h>

namespace artus {
namespace {

// A vertex or cell that knows when it was made: CGAL then orders handles by age and not by memory
// address, and the same solid gives the same triangles in every process.
template <class Base>
class Stamped : public Base {
 public:
  using Has_timestamp = CGAL::Tag_true;
  // CGAL asks for these names.
  template <class Tds>
  struct Rebind_TDS {  // NOLINT(readability-identifier-naming)
    using Other = Stamped<typename Base::template Rebind_TDS<Tds>::Other>;
  };
  using Base::Base;
  [[nodiscard]] std::size_t time_stamp() const { return stamp_; }
  void set_time_stamp(std::size_t stamp) { stamp_ = stamp; }

 private:
  std::size_t stamp_ = static_cast<std::size_t>(-1);  // in no container yet
};

using Traits =
    CGAL::Robust_circumcenter_traits_3<CGAL::Exact_predicates_inexact_constructions_kernel>;
using Vertex = Stamped<CGAL::Surface_mesh_vertex_base_3<Traits>>;
using Cell = Stamped<CGAL::Delaunay_triangulation_cell_base_with_circumcenter_3<
    Traits, CGAL::Surface_mesh_cell_base_3<Traits>>>;
using Triangulation =
    CGAL::Delaunay_triangulation_3<Traits, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
using Point = Traits::Point_3;
using Complex = CGAL::Complex_2_in_triangulation_3<Triangulation>;
using Facets = CGAL::Surface_mesh<Point>;

// CGAL's default error bounds suit coordinates of the order of 1..1000, so it works in mm.
constexpr double kMmPerM = 1e3;
constexpr double kMinAngleDeg = 25;
constexpr unsigned kSeed = 1;

class FieldInMm {
 public:
  explicit FieldInMm(const Field& field) : field_(&field) {}
  double operator()(const Point& p) const {
    return kMmPerM * (*field_)(Vec3(p.x(), p.y(), p.z()) / kMmPerM);
  }

 private:
  const Field* field_;
};

SurfaceMesh to_surface_mesh(const Facets& facets) {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> index(facets.num_vertices());
  for (const auto v : facets.vertices()) {
    const Point& p = facets.point(v);
    index[v.idx()] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(Vec3(p.x(), p.y(), p.z()) / kMmPerM);
  }
  for (const auto f : facets.faces()) {
    Triangle triangle{};
    std::size_t corner = 0;
    for (const auto v : CGAL::vertices_around_face(facets.halfedge(f), facets)) {
      triangle.at(corner++) = index[v.idx()];
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

void wind_outward(SurfaceMesh& mesh) {
  if (signed_volume(mesh) >= 0) return;
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace

Result<SurfaceMesh> compute_surface(const Solid& solid) {
  if (!(solid.field(solid.seed) < 0)) {
    return fail(ErrorCode::failed, "the seed lies outside the solid", solid.name);
  }
  const Vec3 seed = solid.seed * kMmPerM;
  const double reach = solid.reach * kMmPerM;
  const FieldInMm field(solid.field);
  const CGAL::Implicit_surface_3<Traits, FieldInMm> surface(
      field, Traits::Sphere_3(Point(seed.x(), seed.y(), seed.z()), reach * reach), 1e-6);
  const CGAL::Surface_mesh_default_criteria_3<Triangulation> criteria(
      kMinAngleDeg, solid.facet_size * kMmPerM, solid.facet_distance * kMmPerM);
  CGAL::get_default_random() = CGAL::Random(kSeed);  // draws the first points on the surface
  Triangulation triangulation;
  Complex complex(triangulation);
  CGAL::make_surface_mesh(complex, surface, criteria, CGAL::Manifold_tag());
  Facets facets;
  CGAL::facets_in_complex_2_to_triangle_mesh(complex, facets);
  if (facets.is_empty() || !CGAL::is_closed(facets)) {
    return fail(ErrorCode::failed, "no closed surface was found; is the reach long enough?",
                solid.name);
  }
  SurfaceMesh mesh = to_surface_mesh(facets);
  wind_outward(mesh);
  return mesh;
}

}  // namespace artus
