// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <numbers>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <Eigen/Eigenvalues>

#include "artus/anatomy/surfaces/defects_cracks.h"
#include "artus/anatomy/surfaces/repair_steps.h"
#include "artus/anatomy/surfaces/surface_topology.h"

namespace artus {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Rim = std::vector<std::uint32_t>;

/// Longer rims get a fan: the triangulation's worst case grows with the cube of the length.
constexpr std::size_t kLongestRim = 600;

double area_of(const SurfaceMesh& mesh, const std::vector<Triangle>& patch) {
  double area = 0;
  for (const Triangle& t : patch) area += triangle_area(mesh, t);
  return area;
}

Vec3 centre_of(const SurfaceMesh& mesh, const Rim& rim) {
  Vec3 sum = Vec3::Zero();
  for (const auto v : rim) sum += mesh.vertices[v];
  return sum / static_cast<double>(rim.size());
}

/// Triangles from a new vertex at the rim's centre.
std::vector<Triangle> make_fan(SurfaceMesh& mesh, const Rim& rim) {
  const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(centre_of(mesh, rim));
  std::vector<Triangle> fan;
  for (std::size_t k = 0; k < rim.size(); ++k)
    fan.push_back({rim[k], rim[(k + 1) % rim.size()], centre});
  return fan;
}

bool has_edge(const std::vector<EdgeUse>& uses, std::uint32_t a, std::uint32_t b) {
  const std::pair key = std::minmax(a, b);
  const auto it =
      std::lower_bound(uses.begin(), uses.end(), key, [](const EdgeUse& u, const auto& k) {
        return std::pair(u.lo, u.hi) < std::pair<std::uint32_t, std::uint32_t>(k);
      });
  return it != uses.end() && it->lo == key.first && it->hi == key.second;
}

/// Does a side of the patch that is not on the rim exist in the mesh already? `uses` is the mesh's.
bool crowds_an_edge(const std::vector<EdgeUse>& uses, const std::vector<Triangle>& patch,
                    const Rim& rim) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> rim_edges;
  for (std::size_t k = 0; k < rim.size(); ++k)
    rim_edges.emplace_back(std::minmax(rim[k], rim[(k + 1) % rim.size()]));
  std::sort(rim_edges.begin(), rim_edges.end());
  for (const auto& t : patch) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::pair<std::uint32_t, std::uint32_t> side = std::minmax(t[k], t[(k + 1) % 3]);
      if (!std::binary_search(rim_edges.begin(), rim_edges.end(), side) &&
          has_edge(uses, side.first, side.second))
        return true;
    }
  }
  return false;
}

/// The triangulation of least area-and-bend of a rim; empty when there is none to be had.
std::vector<Triangle> triangulate(const SurfaceMesh& mesh, const Rim& rim) {
  std::vector<Kernel::Point_3> points;
  for (const auto v : rim) {
    const Vec3& p = mesh.vertices[v];
    points.emplace_back(p.x(), p.y(), p.z());
  }
  struct Indices {
    std::array<std::size_t, 3> v;
    Indices(std::size_t a, std::size_t b, std::size_t c) : v{a, b, c} {}
  };
  std::vector<Indices> faces;
  try {
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(faces));
  } catch (const std::exception&) {
    return {};
  }
  std::vector<Triangle> patch;
  patch.reserve(faces.size());
  for (const auto& f : faces) patch.push_back({rim[f.v[0]], rim[f.v[1]], rim[f.v[2]]});
  return patch.size() + 2 == rim.size() ? patch : std::vector<Triangle>{};
}

/// How flat and how round the rim is: largest distance to its plane and area against perimeter.
bool is_flat_and_round(const SurfaceMesh& mesh, const Rim& rim) {
  constexpr double kFlatness = 0.1;   // of the mean radius
  constexpr double kRoundness = 0.3;  // 1 for a circle, 4 pi area / perimeter^2
  if (rim.size() < 5) return false;
  const Vec3 centre = centre_of(mesh, rim);
  Vec3 twice_area = Vec3::Zero();
  double perimeter = 0;
  double radius = 0;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const Vec3 a = mesh.vertices[rim[k]] - centre;
    const Vec3 b = mesh.vertices[rim[(k + 1) % rim.size()]] - centre;
    twice_area += a.cross(b);
    perimeter += (b - a).norm();
    radius += a.norm() / static_cast<double>(rim.size());
  }
  const Vec3 normal = twice_area.stableNormalized();
  if (2 * std::numbers::pi * twice_area.norm() < kRoundness * perimeter * perimeter) return false;
  return std::all_of(rim.begin(), rim.end(), [&](std::uint32_t v) {
    return std::abs(normal.dot(mesh.vertices[v] - centre)) <= kFlatness * radius;
  });
}

}  // namespace

Filling cap_flat_ends(SurfaceMesh& mesh, double crack_width, double largest_share) {
  const auto uses = make_edge_uses(mesh);
  const auto pieces = find_pieces(mesh, uses);
  const auto measures = measure_pieces(mesh, uses, pieces);
  std::vector<std::uint32_t> piece_at(mesh.vertices.size(), 0);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (const auto v : mesh.triangles[f]) piece_at[v] = pieces.of_face[f];
  std::vector<bool> has_partner(mesh.vertices.size(), false);
  for (const auto& pair : find_crack_pairs(mesh, uses, crack_width))
    has_partner[pair.a] = has_partner[pair.b] = true;
  Filling filling;
  for (const auto& rim : find_rims(mesh, uses)) {
    const bool is_crack =
        std::any_of(rim.begin(), rim.end(), [&](auto v) { return has_partner[v]; });
    if (is_crack || !is_flat_and_round(mesh, rim)) continue;
    const double piece_area = measures[piece_at[rim[0]]].area;
    const auto cap = make_fan(mesh, rim);
    const double area = area_of(mesh, cap);
    if (area > largest_share * piece_area) {
      mesh.vertices.pop_back();  // the fan's
      continue;
    }
    filling.area += area;
    ++filling.n;
    mesh.triangles.insert(mesh.triangles.end(), cap.begin(), cap.end());
  }
  return filling;
}

Filling fill_holes(SurfaceMesh& mesh) {
  Filling filling;
  auto uses = make_edge_uses(mesh);
  for (const auto& rim : find_rims(mesh, uses)) {
    if (rim.size() < 3) continue;
    std::vector<Triangle> patch;
    if (rim.size() == 3)
      patch = {{rim[0], rim[1], rim[2]}};
    else if (rim.size() <= kLongestRim)
      patch = triangulate(mesh, rim);
    if (patch.empty() || crowds_an_edge(uses, patch, rim)) patch = make_fan(mesh, rim);
    filling.area += area_of(mesh, patch);
    ++filling.n;
    mesh.triangles.insert(mesh.triangles.end(), patch.begin(), patch.end());
    // Two patches may both want the same new edge, so the next one has to know this one's.
    uses = make_edge_uses(mesh);
  }
  return filling;
}

std::size_t thicken_sheets(SurfaceMesh& mesh, double thickness, double open_share) {
  const auto uses = make_edge_uses(mesh);
  const auto pieces = find_pieces(mesh, uses);
  const auto measures = measure_pieces(mesh, uses, pieces);
  const auto is_sheet = [&](const PieceMeasure& m) {
    return m.is_sheet() || m.is_open_beyond(open_share);
  };
  std::vector<Vec3> normal(mesh.vertices.size(), Vec3::Zero());
  const std::size_t n_faces = mesh.triangles.size();
  for (std::size_t f = 0; f < n_faces; ++f) {
    const auto& t = mesh.triangles[f];
    if (!is_sheet(measures[pieces.of_face[f]])) continue;
    const Vec3 n = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                       .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    for (const auto v : t) normal[v] += n;
  }
  // The sheet itself moves up by half the thickness, its copy down; a wall joins them at the rims.
  const auto rims = find_rims(mesh, uses);
  std::vector<std::uint32_t> below(mesh.vertices.size(), 0);
  const std::size_t n_vertices = mesh.vertices.size();
  for (std::size_t v = 0; v < n_vertices; ++v) {
    if (normal[v].isZero(0)) continue;
    const Vec3 half = normal[v].stableNormalized() * thickness / 2;
    below[v] = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vec3 lower = mesh.vertices[v] - half;
    mesh.vertices.push_back(lower);
    mesh.vertices[v] += half;
  }
  for (std::size_t f = 0; f < n_faces; ++f) {
    const Triangle t = mesh.triangles[f];
    if (below[t[0]] != 0) mesh.triangles.push_back({below[t[0]], below[t[2]], below[t[1]]});
  }
  for (const auto& rim : rims) {
    if (below[rim[0]] == 0) continue;
    for (std::size_t k = 0; k < rim.size(); ++k) {
      const auto a = rim[k];
      const auto b = rim[(k + 1) % rim.size()];
      mesh.triangles.push_back({a, b, below[b]});
      mesh.triangles.push_back({a, below[b], below[a]});
    }
  }
  return static_cast<std::size_t>(std::count_if(measures.begin(), measures.end(), is_sheet));
}

}  // namespace artus
