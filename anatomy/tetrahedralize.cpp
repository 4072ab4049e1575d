// SPDX-License-Identifier: AGPL-3.0-or-later
#include "anatomy/tetrahedralize.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include <tetgen.h>

namespace artus {
namespace {

// p: a piecewise linear complex, Y: keep its facets, A: regions, q: radius-edge ratio and dihedral
// angle in degrees, O: local optimisation, Q: quiet.
constexpr const char* kQualitySwitches = "pYAq1.4/12O7/7Q";
constexpr const char* kPlainSwitches = "pYAQ";
// TetGen's tolerances are made for coordinates of order one to a hundred.
constexpr double kScale = 1e3;

struct RegionPoint {
  double volume = 0;
  Vec3 point = Vec3::Zero();
};

// One point well inside each connected part of each region: the centroid of its largest
// tetrahedron.
std::vector<RegionPoint> find_region_points(const TetMesh& mesh, const TetParts& parts) {
  std::vector<RegionPoint> points(parts.region.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    RegionPoint& best = points[parts.part[t]];
    const double volume = tet_volume(mesh, t);
    if (volume <= best.volume) continue;
    best.volume = volume;
    best.point.setZero();
    for (const std::uint32_t v : mesh.tetrahedra[t]) best.point += mesh.vertices[v] / 4;
  }
  return points;
}

void set_points(const TetMesh& mesh, tetgenio& in) {
  in.numberofpoints = static_cast<int>(mesh.vertices.size());
  in.pointlist = new REAL[3 * mesh.vertices.size()];
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      in.pointlist[3 * v + a] = kScale * mesh.vertices[v][static_cast<Eigen::Index>(a)];
    }
  }
}

void set_facets(const TetMesh& mesh, tetgenio& in) {
  in.numberoffacets = static_cast<int>(mesh.interfaces.size());
  in.facetlist = new tetgenio::facet[mesh.interfaces.size()];
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    tetgenio::facet& facet = in.facetlist[i];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::polygon& polygon = facet.polygonlist[0];
    tetgenio::init(&polygon);
    polygon.numberofvertices = 3;
    polygon.vertexlist = new int[3];
    for (std::size_t k = 0; k < 3; ++k) {
      polygon.vertexlist[k] = static_cast<int>(mesh.interfaces[i].vertices[k]);
    }
  }
}

void set_regions(const TetMesh& mesh, const TetParts& parts, tetgenio& in) {
  const std::vector<RegionPoint> points = find_region_points(mesh, parts);
  in.numberofregions = static_cast<int>(points.size());
  in.regionlist = new REAL[5 * points.size()];
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      in.regionlist[5 * i + a] = kScale * points[i].point[static_cast<Eigen::Index>(a)];
    }
    in.regionlist[5 * i + 3] = parts.region[i];
    in.regionlist[5 * i + 4] = -1;
  }
}

bool run(const char* switches, tetgenio& in, tetgenio& out) {
  try {
    std::string text = switches;
    tetrahedralize(text.data(), &in, &out);
    return out.numberoftetrahedra > 0;
  } catch (int) {
    return false;
  } catch (const std::exception&) {
    return false;
  }
}

Result<TetMesh> to_mesh(const TetMesh& before, const tetgenio& out) {
  if (out.numberoftetrahedronattributes != 1 || out.numberofcorners != 4) {
    return fail(ErrorCode::failed, "TetGen returned no regions");
  }
  TetMesh mesh;
  mesh.interfaces = before.interfaces;
  mesh.vertices = before.vertices;
  for (auto v = before.vertices.size(); v < static_cast<std::size_t>(out.numberofpoints); ++v) {
    const REAL* p = out.pointlist + 3 * v;
    mesh.vertices.emplace_back(p[0] / kScale, p[1] / kScale, p[2] / kScale);
  }
  for (std::size_t t = 0; t < static_cast<std::size_t>(out.numberoftetrahedra); ++t) {
    const int* c = out.tetrahedronlist + 4 * t;
    std::array<std::uint32_t, 4> tet{
        static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]),
        static_cast<std::uint32_t>(c[2]), static_cast<std::uint32_t>(c[3])};
    mesh.tetrahedra.push_back(tet);
    mesh.regions.push_back(static_cast<RegionId>(std::lround(out.tetrahedronattributelist[t])));
    if (tet_volume(mesh, t) < 0) std::swap(mesh.tetrahedra[t][2], mesh.tetrahedra[t][3]);
  }
  return mesh;
}

}  // namespace

Result<FillMethod> fill_with_tetgen(TetMesh& mesh, const TetNeighbours& neighbours) {
  const TetParts parts = find_tet_parts(mesh, neighbours);
  for (const FillMethod method : {FillMethod::quality, FillMethod::plain}) {
    tetgenio in;
    tetgenio out;
    set_points(mesh, in);
    set_facets(mesh, in);
    set_regions(mesh, parts, in);
    if (!run(method == FillMethod::quality ? kQualitySwitches : kPlainSwitches, in, out)) continue;
    Result<TetMesh> filled = to_mesh(mesh, out);
    if (!filled) return tl::unexpected(filled.error());
    mesh = std::move(*filled);
    return method;
  }
  return FillMethod::kept;
}

}  // namespace artus
