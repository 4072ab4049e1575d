// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/mesh/tetrahedralize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>

#include <malloc.h>
#include <tetgen.h>

#include "artus/detail/anatomy/compile/mesh/isolated.h"

namespace artus {
namespace {

// p: a piecewise linear complex, Y: keep its facets, A: regions, q: radius-edge ratio and dihedral
// angle in degrees, a: the regions' bounds of volume, O: local optimisation, Q: quiet.
constexpr const char* kQualitySwitches = "pYAaq1.4/12O7/7Q";
constexpr const char* kPlainSwitches = "pYAQ";
// TetGen's tolerances are made for coordinates of order one to a hundred.
constexpr double kScale = 1e3;

// So many groups of parts are filled each by itself, at once where there are processors: whatever
// their number, the tetrahedra are the same.
constexpr std::size_t kGroups = 4;

// A part of a region, and a point well inside it: the centroid of its largest tetrahedron.
struct PartPoint {
  double volume = 0;  // of that tetrahedron
  Vec3 point = Vec3::Zero();
  std::size_t tetrahedra = 0;
};

std::vector<PartPoint> find_part_points(const TetMesh& mesh, const TetParts& parts) {
  std::vector<PartPoint> points(parts.region.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    PartPoint& best = points[parts.part[t]];
    ++best.tetrahedra;
    const double volume = tet_volume(mesh, t);
    if (volume <= best.volume) continue;
    best.volume = volume;
    best.point.setZero();
    for (const std::uint32_t v : mesh.tetrahedra[t]) best.point += mesh.vertices[v] / 4;
  }
  return points;
}

// Which group each part belongs to: the largest first, each to the group that has least so far.
std::vector<std::size_t> assign_groups(const std::vector<PartPoint>& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].tetrahedra > points[b].tetrahedra;
  });
  std::array<std::size_t, kGroups> load{};
  std::vector<std::size_t> group(points.size());
  for (const std::size_t part : order) {
    group[part] =
        static_cast<std::size_t>(std::min_element(load.begin(), load.end()) - load.begin());
    load[group[part]] += points[part].tetrahedra;
  }
  return group;
}

// What TetGen fills at once: some parts and the triangles around each. The other parts are holes.
struct Group {
  std::vector<std::uint32_t> vertices;  // of the complex, ascending
  std::vector<std::array<std::uint32_t, 3>> facets;
  std::vector<std::uint32_t> tetrahedra;  // of the complex, ascending
  std::vector<std::uint32_t> parts;
  std::vector<std::uint32_t> holes;
};

std::vector<Group> make_groups(const TetMesh& mesh, const TetNeighbours& neighbours,
                               const TetParts& parts, const std::vector<PartPoint>& points) {
  const std::vector<std::size_t> group_of = assign_groups(points);
  std::vector<Group> groups(kGroups);
  for (std::uint32_t part = 0; part < group_of.size(); ++part)
    for (std::size_t g = 0; g < kGroups; ++g)
      (group_of[part] == g ? groups[g].parts : groups[g].holes).push_back(part);
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const std::size_t g = group_of[parts.part[t]];
    groups[g].tetrahedra.push_back(t);
    for (std::size_t k = 0; k < 4; ++k) {
      groups[g].vertices.push_back(mesh.tetrahedra[t][k]);
      const std::uint32_t n = neighbours[t][k];
      if (n != kNoTet && parts.part[n] == parts.part[t]) continue;
      if (n != kNoTet && group_of[parts.part[n]] == g && n < t) continue;  // it has it already
      groups[g].facets.push_back(tet_face(mesh.tetrahedra[t], static_cast<int>(k)));
    }
  }
  for (Group& g : groups) {
    std::sort(g.vertices.begin(), g.vertices.end());
    g.vertices.erase(std::unique(g.vertices.begin(), g.vertices.end()), g.vertices.end());
  }
  groups.erase(
      std::remove_if(groups.begin(), groups.end(), [](const Group& g) { return g.parts.empty(); }),
      groups.end());
  return groups;
}

void set_point(const Vec3& p, REAL* out) {
  for (std::size_t a = 0; a < 3; ++a) out[a] = kScale * p[static_cast<Eigen::Index>(a)];
}

void set_points(const TetMesh& mesh, const Group& group, tetgenio& in) {
  in.numberofpoints = static_cast<int>(group.vertices.size());
  in.pointlist = new REAL[3 * group.vertices.size()];
  for (std::size_t v = 0; v < group.vertices.size(); ++v)
    set_point(mesh.vertices[group.vertices[v]], in.pointlist + 3 * v);
}

void set_facets(const Group& group, tetgenio& in) {
  in.numberoffacets = static_cast<int>(group.facets.size());
  in.facetlist = new tetgenio::facet[group.facets.size()];
  for (std::size_t i = 0; i < group.facets.size(); ++i) {
    tetgenio::facet& facet = in.facetlist[i];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::polygon& polygon = facet.polygonlist[0];
    tetgenio::init(&polygon);
    polygon.numberofvertices = 3;
    polygon.vertexlist = new int[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at =
          std::lower_bound(group.vertices.begin(), group.vertices.end(), group.facets[i][k]);
      polygon.vertexlist[k] = static_cast<int>(at - group.vertices.begin());
    }
  }
}

// The largest volume of a region's tetrahedra in TetGen's units, or -1.
double largest_volume(std::span<const RegionSizing> sizing, RegionId region) {
  const double kRegular = 8 / (9 * std::sqrt(3.0));  // of the cube of its circumradius
  if (region >= sizing.size() || !(sizing[region].cell_size > 0)) return -1;
  return kRegular * std::pow(kScale * sizing[region].cell_size, 3);
}

void set_regions(const Group& group, const TetParts& parts, const std::vector<PartPoint>& points,
                 std::span<const RegionSizing> sizing, tetgenio& in) {
  in.numberofregions = static_cast<int>(group.parts.size());
  in.regionlist = new REAL[5 * group.parts.size()];
  for (std::size_t i = 0; i < group.parts.size(); ++i) {
    set_point(points[group.parts[i]].point, in.regionlist + 5 * i);
    in.regionlist[5 * i + 3] = parts.region[group.parts[i]];
    in.regionlist[5 * i + 4] = largest_volume(sizing, parts.region[group.parts[i]]);
  }
  in.numberofholes = static_cast<int>(group.holes.size());
  in.holelist = new REAL[3 * group.holes.size()];
  for (std::size_t i = 0; i < group.holes.size(); ++i)
    set_point(points[group.holes[i]].point, in.holelist + 3 * i);
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
std::string run_tetgen(const char* switches, tetgenio& in) {
  tetgenio out;
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

std::optional<Filling> parse_filling(const std::optional<std::string>& bytes, const Group& group) {
  if (!bytes) return std::nullopt;
  Filling filling;
  std::size_t at = 0;
  if (!take_array(*bytes, at, filling.points) || !take_array(*bytes, at, filling.corners) ||
      !take_array(*bytes, at, filling.regions) || filling.regions.empty() ||
      filling.points.size() < 3 * group.vertices.size())
    return std::nullopt;
  return filling;
}

// Fills the groups that `fillings` still lacks.
void find_fillings(const char* switches, const std::vector<Group>& groups,
                   const std::function<void(const Group&, tetgenio&)>& set,
                   std::vector<std::optional<Filling>>& fillings) {
  // Fifty times what it takes on an idle machine, so that a busy one gets the same tetrahedra.
  constexpr double kPatience = 300;            // s
  constexpr double kPatiencePerFacet = 10e-3;  // s
  std::vector<std::function<std::string()>> works;
  std::vector<std::size_t> which;
  std::size_t most = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (fillings[g]) continue;
    most = std::max(most, groups[g].facets.size());
    which.push_back(g);
    works.emplace_back([&, g] {
      tetgenio in;
      set(groups[g], in);
      return run_tetgen(switches, in);
    });
  }
  const double seconds = kPatience + kPatiencePerFacet * static_cast<double>(most);
  const std::size_t at_once = std::thread::hardware_concurrency();
  const auto results = run_isolated(works, seconds, at_once);
  for (std::size_t i = 0; i < which.size(); ++i)
    fillings[which[i]] = parse_filling(results[i], groups[which[i]]);
}

// A group's tetrahedra as they were.
void keep_group(const TetMesh& before, const Group& group, TetMesh& mesh) {
  for (const std::uint32_t t : group.tetrahedra) {
    mesh.tetrahedra.push_back(before.tetrahedra[t]);
    mesh.regions.push_back(before.regions[t]);
  }
}

void append_group(const Group& group, const Filling& filling, TetMesh& mesh) {
  const std::size_t n_known = group.vertices.size();
  const auto first_new = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::size_t v = 3 * n_known; v < filling.points.size(); v += 3)
    mesh.vertices.emplace_back(filling.points[v] / kScale, filling.points[v + 1] / kScale,
                               filling.points[v + 2] / kScale);
  for (std::size_t t = 0; t < filling.regions.size(); ++t) {
    std::array<std::uint32_t, 4> tet{};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto v = static_cast<std::uint32_t>(filling.corners[4 * t + k]);
      tet[k] =
          v < n_known ? group.vertices[v] : first_new + static_cast<std::uint32_t>(v - n_known);
    }
    mesh.tetrahedra.push_back(tet);
    mesh.regions.push_back(static_cast<RegionId>(std::lround(filling.regions[t])));
    const std::size_t last = mesh.tetrahedra.size() - 1;
    if (tet_volume(mesh, last) < 0) std::swap(mesh.tetrahedra[last][2], mesh.tetrahedra[last][3]);
  }
}

}  // namespace

FillMethod fill_with_tetgen(TetMesh& mesh, const TetNeighbours& neighbours,
                            std::span<const RegionSizing> sizing) {
  const TetParts parts = find_tet_parts(mesh, neighbours);
  const std::vector<PartPoint> points = find_part_points(mesh, parts);
  const std::vector<Group> groups = make_groups(mesh, neighbours, parts, points);
  const auto set = [&](const Group& group, tetgenio& in) {
    set_points(mesh, group, in);
    set_facets(group, in);
    set_regions(group, parts, points, sizing, in);
  };
  malloc_trim(0);  // a child's memory begins as a copy of this process's
  std::vector<std::optional<Filling>> fillings(groups.size());
  const auto is_done = [&] {
    return std::all_of(fillings.begin(), fillings.end(),
                       [](const auto& f) { return f.has_value(); });
  };
  FillMethod method = FillMethod::quality;
  find_fillings(kQualitySwitches, groups, set, fillings);
  if (!is_done()) {
    method = FillMethod::plain;
    find_fillings(kPlainSwitches, groups, set, fillings);
  }
  if (!is_done()) method = FillMethod::kept;
  TetMesh filled;
  filled.interfaces = mesh.interfaces;
  filled.vertices = mesh.vertices;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (fillings[g]) {
      append_group(groups[g], *fillings[g], filled);
    } else {
      keep_group(mesh, groups[g], filled);
    }
    fillings[g].reset();
  }
  mesh = std::move(filled);
  return method;
}

}  // namespace artus
