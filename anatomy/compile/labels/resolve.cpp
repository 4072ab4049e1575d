// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/resolve.h"

#include <algorithm>
#include <exception>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Unique_hash_map.h>
#include <CGAL/refine_mesh_3.h>

#include "artus/detail/anatomy/compile/labels/resolve_seeds.h"
#include "artus/detail/core/check.h"

namespace artus {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

constexpr double kFacetAngle = 25;    // deg, CGAL guarantees termination up to 30
constexpr double kErrorBound = 1e-4;  // of the box: where a boundary is found
constexpr double kUnbounded = 1e9;    // m
constexpr std::uint32_t kUnsetNumber = 0xffffffffU;

// What is not meshed is 0 for the mesher, whether outside the body or beyond the region of
// interest.
struct MeshedLabel {
  const RegionLabels* labels;
  RegionId operator()(const Vec3& p) const {
    const RegionId region = labels->at(p);
    return region == kBeyond ? kOutside : region;
  }
  int operator()(const Point& p) const { return (*this)(Vec3(p.x(), p.y(), p.z())); }
};

// The finest wish of the regions that meet in a mesh element.
struct SizeField {
  using FT = double;
  using Point_3 = Point;
  using Index = Domain::Index;
  const std::vector<RegionSizing>* sizing;
  double RegionSizing::*member;

  [[nodiscard]] double of(int region) const {
    return region < kFirstRegion ? kUnbounded : (*sizing)[static_cast<std::size_t>(region)].*member;
  }
  [[nodiscard]] double between(int a, int b) const { return std::min(of(a), of(b)); }
  FT operator()(const Point_3& /*p*/, int /*dimension*/, const Index& index) const {
    if (const auto* patch = boost::get<Domain::Surface_patch_index>(&index)) {
      return between(patch->first, patch->second);
    }
    return of(boost::get<Domain::Subdomain_index>(index));
  }
};

void insert_seeds(const std::vector<BoundarySeed>& seeds, Complex& complex) {
  for (const BoundarySeed& seed : seeds) {
    const Vec3& p = seed.point;
    const auto v =
        complex.triangulation().insert(Triangulation::Weighted_point(Point(p[0], p[1], p[2]), 0));
    if (v == Triangulation::Vertex_handle()) continue;
    complex.set_dimension(v, 2);
    complex.set_index(v, Domain::Index(Domain::Surface_patch_index(std::min(seed.from, seed.to),
                                                                   std::max(seed.from, seed.to))));
  }
}

TetMesh to_tet_mesh(const Complex& complex) {
  TetMesh mesh;
  CGAL::Unique_hash_map<Triangulation::Vertex_handle, std::uint32_t> numbers(kUnsetNumber);
  for (auto c = complex.cells_in_complex_begin(); c != complex.cells_in_complex_end(); ++c) {
    std::array<std::uint32_t, 4> tet{};
    for (int k = 0; k < 4; ++k) {
      const auto v = c->vertex(k);
      if (numbers[v] == kUnsetNumber) {
        numbers[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.emplace_back(v->point().x(), v->point().y(), v->point().z());
      }
      tet[static_cast<std::size_t>(k)] = numbers[v];
    }
    mesh.tetrahedra.push_back(tet);
    mesh.regions.push_back(static_cast<RegionId>(complex.subdomain_index(c)));
  }
  return mesh;
}

void refine(const RegionLabels& labels, const ResolveOptions& options,
            const std::vector<BoundarySeed>& seeds, Complex& complex) {
  namespace param = CGAL::parameters;
  const Vec3& lower = options.box.lower;
  const Vec3& upper = options.box.upper;
  CGAL::Random random(0);
  const Domain domain(param::function = MeshedLabel{&labels},
                      param::bounding_object =
                          CGAL::Bbox_3(lower[0], lower[1], lower[2], upper[0], upper[1], upper[2]),
                      param::relative_error_bound = kErrorBound, param::p_rng = &random);
  const Criteria criteria(
      CGAL::Mesh_facet_criteria_3<Triangulation>(
          kFacetAngle, SizeField{&options.sizing, &RegionSizing::facet_size},
          SizeField{&options.sizing, &RegionSizing::facet_distance},
          CGAL::FACET_VERTICES_ON_SURFACE),
      CGAL::Mesh_cell_criteria_3<Triangulation>(0., 0.));  // cells are refined by who fills it
  insert_seeds(seeds, complex);
  CGAL::refine_mesh_3(complex, domain, criteria, param::no_exude(), param::no_perturb(),
                      param::no_reset_c3t3(), param::no_odt(), param::no_lloyd());
}

}  // namespace

Result<TetMesh> resolve_regions(const RegionLabels& labels, const ResolveOptions& options,
                                const Progress& progress) {
  const MeshedLabel label{&labels};
  const SizeField size{&options.sizing, &RegionSizing::facet_size};
  double largest = 0;
  for (const RegionSizing& s : options.sizing) largest = std::max(largest, s.facet_size);
  ARTUS_REQUIRE(largest > 0 && options.seed_spacing > 0, "sizes must be positive");
  if (progress) progress("finding boundaries", 0);
  const auto crossings = find_boundary_seeds(label, options.box, options.seed_spacing);
  const auto seeds = thin_seeds(
      crossings, [&](const BoundarySeed& s) { return size.between(s.from, s.to); }, largest);
  if (seeds.size() < 4) {
    return fail(ErrorCode::failed,
                "there is nothing to mesh: no region boundary inside the region of interest, or "
                "facet_size is larger than all of them");
  }
  if (progress) progress("meshing boundaries", 0);
  Complex complex;
  try {
    refine(labels, options, seeds, complex);
  } catch (const std::exception& e) {
    return fail(ErrorCode::failed, std::string("the mesher gave up: ") + e.what());
  }
  if (complex.number_of_cells_in_complex() == 0) {
    return fail(ErrorCode::failed, "the mesher found no volume inside the boundaries");
  }
  return to_tet_mesh(complex);
}

}  // namespace artus
