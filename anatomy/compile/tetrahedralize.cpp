// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile/tetrahedralize.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include <malloc.h>
#include <tetgen.h>

#include "artus/anatomy/compile/isolated.h"

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

// What TetGen made, as it travels from the process that ran it.
struct Filling {
  std::vector<double> points;         // (n_points, 3), scaled
  std::vector<std::int32_t> corners;  // (n_tets, 4)
  std::vector<double> regions;        // (n_tets)
};

template <class T>
void append_array(std::string& bytes, const T* data, std::size_t count) {
  const std::uint64_t n = count;
  bytes.append(reinterpret_cast<const char*>(&n), sizeof n);  // NOLINT: plain numbers as bytes
  bytes.append(reinterpret_cast<const char*>(data), count * sizeof(T));  // NOLINT
}

template <class T>
bool take_array(const std::string& bytes, std::size_t& at, std::vector<T>& out) {
  std::uint64_t n = 0;
  if (bytes.size() - at < sizeof n) return false;
  std::memcpy(&n, bytes.data() + at, sizeof n);
  at += sizeof n;
  if (n > (bytes.size() - at) / sizeof(T)) return false;
  out.resize(n);
  std::memcpy(out.data(), bytes.data() + at, n * sizeof(T));
  at += n * sizeof(T);
  return true;
}

// Runs in the child process; TetGen throws integers, and its clean-up after that may crash.
std::string run_tetgen(const char* switches, const TetMesh& mesh, const TetParts& parts) {
  tetgenio in;
  tetgenio out;
  set_points(mesh, in);
  set_facets(mesh, in);
  set_regions(mesh, parts, in);
  std::string text = switches;
  tetrahedralize(text.data(), &in, &out);
  std::string bytes;
  if (out.numberoftetrahedronattributes != 1 || out.numberofcorners != 4) return bytes;
  const auto n_tets = static_cast<std::size_t>(out.numberoftetrahedra);
  append_array(bytes, out.pointlist, 3 * static_cast<std::size_t>(out.numberofpoints));
  append_array(bytes, out.tetrahedronlist, 4 * n_tets);
  append_array(bytes, out.tetrahedronattributelist, n_tets);
  return bytes;
}

std::optional<Filling> find_filling(const char* switches, const TetMesh& mesh,
                                    const TetParts& parts) {
  // Fifty times what it takes on an idle machine, so that a busy one gets the same tetrahedra.
  constexpr double kPatience = 300;                // s
  constexpr double kPatiencePerInterface = 10e-3;  // s
  const double seconds =
      kPatience + kPatiencePerInterface * static_cast<double>(mesh.interfaces.size());
  const auto bytes = run_isolated([&] { return run_tetgen(switches, mesh, parts); }, seconds);
  if (!bytes) return std::nullopt;
  Filling filling;
  std::size_t at = 0;
  if (!take_array(*bytes, at, filling.points) || !take_array(*bytes, at, filling.corners) ||
      !take_array(*bytes, at, filling.regions) || filling.regions.empty() ||
      filling.points.size() < 3 * mesh.vertices.size()) {
    return std::nullopt;
  }
  return filling;
}

TetMesh to_mesh(const TetMesh& before, const Filling& filling) {
  TetMesh mesh;
  mesh.interfaces = before.interfaces;
  mesh.vertices = before.vertices;
  for (std::size_t v = 3 * before.vertices.size(); v < filling.points.size(); v += 3) {
    mesh.vertices.emplace_back(filling.points[v] / kScale, filling.points[v + 1] / kScale,
                               filling.points[v + 2] / kScale);
  }
  for (std::size_t t = 0; t < filling.regions.size(); ++t) {
    std::array<std::uint32_t, 4> tet{};
    for (std::size_t k = 0; k < 4; ++k) {
      tet[k] = static_cast<std::uint32_t>(filling.corners[4 * t + k]);
    }
    mesh.tetrahedra.push_back(tet);
    mesh.regions.push_back(static_cast<RegionId>(std::lround(filling.regions[t])));
    if (tet_volume(mesh, t) < 0) std::swap(mesh.tetrahedra[t][2], mesh.tetrahedra[t][3]);
  }
  return mesh;
}

}  // namespace

FillMethod fill_with_tetgen(TetMesh& mesh, const TetNeighbours& neighbours) {
  const TetParts parts = find_tet_parts(mesh, neighbours);
  malloc_trim(0);  // the child's memory begins as a copy of this process's
  for (const FillMethod method : {FillMethod::quality, FillMethod::plain}) {
    const char* switches = method == FillMethod::quality ? kQualitySwitches : kPlainSwitches;
    if (const auto filling = find_filling(switches, mesh, parts)) {
      mesh = to_mesh(mesh, *filling);
      return method;
    }
  }
  return FillMethod::kept;
}

}  // namespace artus
