// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/anatomy/surfaces/defects_cracks.h"
#include "artus/detail/anatomy/surfaces/repair_rims.h"
#include "artus/detail/anatomy/surfaces/repair_steps.h"

namespace artus {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Longer rims get a flat patch or a fan: the smooth one's worst case grows with the cube of the
/// length.
constexpr std::size_t kLongestRim = 600;
constexpr double kLargeOpening = 0.02;  // of the surface's area: closed flat rather than smoothly
constexpr double kDeep = 0.75;          // of a piece's area, the largest jagged cut through a solid

double area_of(const SurfaceMesh& mesh, const std::vector<Triangle>& triangles) {
  double area = 0;
  for (const Triangle& t : triangles) area += triangle_area(mesh, t);
  return area;
}

/// Triangles for an opening and the vertices they add to the mesh.
struct Patch {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

void add(SurfaceMesh& mesh, const Patch& patch) {
  mesh.vertices.insert(mesh.vertices.end(), patch.vertices.begin(), patch.vertices.end());
  mesh.triangles.insert(mesh.triangles.end(), patch.triangles.begin(), patch.triangles.end());
}

/// Triangles from a new vertex at the rim's centre.
Patch make_fan(const SurfaceMesh& mesh, const Rim& rim) {
  const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
  Patch fan;
  fan.vertices.push_back(measure_rim(mesh, rim).centre);
  for (std::size_t k = 0; k < rim.size(); ++k)
    fan.triangles.push_back({rim[k], rim[(k + 1) % rim.size()], centre});
  return fan;
}

/// Whether all of a rim is seen from its centre, so that a fan does not lie over itself.
bool is_star(const SurfaceMesh& mesh, const Rim& rim, const RimShape& shape) {
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const Vec3 a = mesh.vertices[rim[k]] - shape.centre;
    const Vec3 b = mesh.vertices[rim[(k + 1) % rim.size()]] - shape.centre;
    if (!(a.cross(b).dot(shape.normal) > 0)) return false;
  }
  return true;
}

/// The triangulation of least bend and area of a rim; empty when there is none to be had.
Patch make_smooth_patch(const SurfaceMesh& mesh, const std::vector<EdgeUse>& uses, const Rim& rim) {
  if (rim.size() > kLongestRim) return {};
  Patch patch;
  if (rim.size() == 3) {
    patch.triangles = {{rim[0], rim[1], rim[2]}};
  } else {
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
    for (const auto& f : faces) patch.triangles.push_back({rim[f.v[0]], rim[f.v[1]], rim[f.v[2]]});
    if (patch.triangles.size() + 2 != rim.size()) return {};
  }
  return crowds_an_edge(uses, patch.triangles, rim) ? Patch{} : patch;
}

/// The rim drawn in towards its centre, at the rim's mean height: a patch over teeth would lie at
/// the height of those that stand innermost. Empty for a rim in a plane.
std::vector<Vec3> make_inner_ring(const SurfaceMesh& mesh, const Rim& rim) {
  constexpr double kDrawnIn = 0.9;
  const RimShape shape = measure_rim(mesh, rim);
  std::vector<Vec3> ring;
  if (shape.is_planar()) return ring;
  for (const auto v : rim) {
    const Vec3 off = mesh.vertices[v] - shape.centre;
    ring.push_back(shape.centre + kDrawnIn * (off - shape.normal.dot(off) * shape.normal));
  }
  return ring;
}

/// The triangulation of rims as they are seen along `normal`.
Patch make_flat_patch(SurfaceMesh& mesh, const std::vector<EdgeUse>& uses,
                      const std::vector<Rim>& rims, const Vec3& normal) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  Rim inner;
  if (rims.size() == 1) {
    for (const Vec3& p : make_inner_ring(mesh, rims.front())) {
      inner.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(p);
    }
  }
  Patch patch;
  patch.triangles = triangulate_flat(mesh, uses, rims, normal, inner);
  std::map<std::uint32_t, std::uint32_t> kept;  // of the new vertices, those inside the rim
  for (Triangle& t : patch.triangles)
    for (auto& v : t) {
      if (v < n) continue;
      const auto at = kept.emplace(v, n + static_cast<std::uint32_t>(kept.size()));
      if (at.second) patch.vertices.push_back(mesh.vertices[v]);
      v = at.first->second;
    }
  mesh.vertices.resize(n);
  return patch;
}

/// Pairs of faces, one of the patch, that cut through each other.
std::size_t count_crossings(SurfaceMesh& mesh, const Patch& patch) {
  const std::size_t n = mesh.vertices.size();
  mesh.vertices.insert(mesh.vertices.end(), patch.vertices.begin(), patch.vertices.end());
  Eigen::AlignedBox3d box;
  for (const Triangle& t : patch.triangles)
    for (const auto v : t) box.extend(mesh.vertices[v]);
  SurfaceMesh around;
  around.triangles = patch.triangles;
  for (const Triangle& t : mesh.triangles) {
    Eigen::AlignedBox3d own;
    for (const auto v : t) own.extend(mesh.vertices[v]);
    if (box.intersects(own)) around.triangles.push_back(t);
  }
  std::swap(around.vertices, mesh.vertices);
  std::size_t crossings = 0;
  for (const auto& pair : find_self_intersections(around))
    crossings += pair.first < patch.triangles.size() ? 1U : 0U;
  std::swap(around.vertices, mesh.vertices);
  mesh.vertices.resize(n);
  return crossings;
}

/// What is known of all openings of a mesh.
struct Openings {
  std::vector<Rim> rims;
  std::vector<RimShape> shapes;
  std::vector<std::uint32_t> piece;  // (n_rims)
  std::vector<double> piece_area;    // (n_pieces) m^2
  std::vector<std::size_t> hole_of;  // (n_rims) the rim whose cut it is a hole in, or kNone
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  Openings(const SurfaceMesh& mesh, const std::vector<EdgeUse>& uses)
      : rims(find_rims(mesh, uses)), piece(rims.size()), hole_of(rims.size(), kNone) {
    const auto pieces = find_pieces(mesh, uses);
    for (const auto& m : measure_pieces(mesh, uses, pieces)) piece_area.push_back(m.area);
    std::vector<std::uint32_t> piece_at(mesh.vertices.size(), 0);
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
      for (const auto v : mesh.triangles[f]) piece_at[v] = pieces.of_face[f];
    for (std::size_t i = 0; i < rims.size(); ++i) {
      shapes.push_back(measure_rim(mesh, rims[i]));
      piece[i] = piece_at[rims[i][0]];
    }
    for (std::size_t i = 0; i < rims.size(); ++i)
      for (std::size_t j = 0; j < rims.size(); ++j)
        if (i != j && piece[i] == piece[j] && shapes[j].is_jagged() &&
            (hole_of[i] == kNone || shapes[j].area < shapes[hole_of[i]].area) &&
            is_hole_in(mesh, rims[i], shapes[i], rims[j], shapes[j]))
          hole_of[i] = j;
  }
  [[nodiscard]] std::vector<std::size_t> holes_in(std::size_t rim) const {
    std::vector<std::size_t> holes;
    for (std::size_t i = 0; i < rims.size(); ++i)
      if (hole_of[i] == rim) holes.push_back(i);
    return holes;
  }
};

/// Which rims are cuts by a plane: wide, and not the two lips of one seam.
class FlatCuts {
 public:
  FlatCuts(const SurfaceMesh& mesh, const std::vector<EdgeUse>& uses, const Openings& openings,
           double crack_width)
      : openings_(openings), is_crack_(openings.rims.size()), is_cut_(openings.rims.size()) {
    std::map<std::uint32_t, std::size_t> rim_at;
    for (std::size_t i = 0; i < openings.rims.size(); ++i)
      for (const auto v : openings.rims[i]) rim_at[v] = i;
    std::vector<std::size_t> n_elsewhere(openings.rims.size(), 0);
    for (const auto& pair : find_crack_pairs(mesh, uses, crack_width)) {
      const auto a = rim_at.find(pair.a);
      const auto b = rim_at.find(pair.b);
      if (a == rim_at.end() || b == rim_at.end()) continue;
      is_crack_[a->second] = is_crack_[b->second] = true;
      if (a->second == b->second) continue;
      ++n_elsewhere[a->second];
      ++n_elsewhere[b->second];
    }
    for (std::size_t i = 0; i < is_cut_.size(); ++i)
      is_cut_[i] = openings.shapes[i].is_planar() && openings.shapes[i].width() > crack_width &&
                   2 * n_elsewhere[i] <= openings.rims[i].size();
  }
  [[nodiscard]] bool is_crack(std::size_t rim) const { return is_crack_[rim]; }
  [[nodiscard]] bool is_cut(std::size_t rim) const { return is_cut_[rim]; }
  /// A piece with cuts by two planes is no sheet, however large they are.
  [[nodiscard]] bool is_cut_twice(std::uint32_t piece) const {
    constexpr double kParallel = 0.999;
    const RimShape* first = nullptr;
    for (std::size_t i = 0; i < is_cut_.size(); ++i) {
      if (!is_cut_[i] || openings_.piece[i] != piece) continue;
      const RimShape& other = openings_.shapes[i];
      if (first == nullptr) first = &other;
      const double off = std::abs(first->normal.dot(other.centre - first->centre));
      if (std::abs(first->normal.dot(other.normal)) < kParallel || off > 0.1 * first->radius)
        return true;
    }
    return false;
  }

 private:
  const Openings& openings_;
  std::vector<bool> is_crack_;
  std::vector<bool> is_cut_;
};

/// A vessel's end, or the end of anything that is round there.
bool is_flat_and_round(const Rim& rim, const RimShape& shape) {
  constexpr double kFlatness = 0.1;  // of the mean radius
  constexpr double kRoundness = 0.3;
  return rim.size() >= 5 && shape.roundness() >= kRoundness && shape.bend <= kFlatness;
}

/// The way to close an opening that crosses fewest faces, the first among equals; `crossings` grows
/// by them.
Patch choose_patch(SurfaceMesh& mesh, const std::vector<EdgeUse>& uses, const Rim& rim,
                   bool flat_first, std::size_t& crossings) {
  Patch best = make_smooth_patch(mesh, uses, rim);
  if (rim.size() == 3) return best.triangles.empty() ? make_fan(mesh, rim) : best;
  const Patch smooth = std::exchange(best, {});
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  const auto consider = [&](Patch patch) {
    if (patch.triangles.empty() || fewest == 0) return;
    const std::size_t n = count_crossings(mesh, patch);
    if (n >= fewest) return;
    fewest = n;
    best = std::move(patch);
  };
  const RimShape shape = measure_rim(mesh, rim);
  const auto consider_flat = [&] {
    if (fewest > 0 && shape.is_jagged()) consider(make_flat_patch(mesh, uses, {rim}, shape.normal));
  };
  if (flat_first) consider_flat();
  consider(smooth);
  if (!flat_first) consider_flat();
  consider(make_fan(mesh, rim));
  crossings += fewest;
  return best;
}

}  // namespace

Filling cap_flat_ends(SurfaceMesh& mesh, const CapLimits& limits) {
  const auto uses = make_edge_uses(mesh);
  const Openings openings(mesh, uses);
  const FlatCuts cuts(mesh, uses, openings, limits.crack_width);
  Filling filling;
  for (std::size_t i = 0; i < openings.rims.size(); ++i) {
    const Rim& rim = openings.rims[i];
    const RimShape& shape = openings.shapes[i];
    const bool is_cut = cuts.is_cut(i) && rim.size() > 3;
    if (!is_cut && (cuts.is_crack(i) || !is_flat_and_round(rim, shape))) continue;
    if (openings.hole_of[i] != Openings::kNone && is_cut) continue;  // with the one around it
    std::vector<Rim> rims{rim};
    for (const std::size_t hole : openings.holes_in(i))
      if (is_cut && cuts.is_cut(hole)) rims.push_back(openings.rims[hole]);
    const Patch cap = rims.size() == 1 && rim.size() >= 5 && is_star(mesh, rim, shape)
                          ? make_fan(mesh, rim)
                          : make_flat_patch(mesh, uses, rims, shape.normal);
    SurfaceMesh closed;
    closed.vertices = mesh.vertices;
    add(closed, cap);
    const double area = area_of(closed, cap.triangles);
    double largest = limits.largest_share;
    if (is_cut && limits.largest_cut_share > 0)
      largest = cuts.is_cut_twice(openings.piece[i]) ? std::numeric_limits<double>::infinity()
                                                     : limits.largest_cut_share;
    if (cap.triangles.empty() || area > largest * openings.piece_area[openings.piece[i]]) continue;
    filling.area += area;
    filling.n += rims.size();
    add(mesh, cap);
  }
  return filling;
}

Filling fill_holes(SurfaceMesh& mesh, bool flat_first) {
  Filling filling;
  auto uses = make_edge_uses(mesh);
  const Openings openings(mesh, uses);
  const double large = kLargeOpening * surface_area(mesh);
  for (std::size_t i = 0; i < openings.rims.size(); ++i) {
    const Rim& rim = openings.rims[i];
    const RimShape& shape = openings.shapes[i];
    if (rim.size() < 3) continue;
    const Patch patch =
        choose_patch(mesh, uses, rim, flat_first || shape.area > large, filling.crossings);
    const std::size_t first = mesh.triangles.size();
    add(mesh, patch);
    double area = 0;
    for (std::size_t f = first; f < mesh.triangles.size(); ++f)
      area += triangle_area(mesh, mesh.triangles[f]);
    filling.area += area;
    ++filling.n;
    const bool is_cut = shape.is_jagged() && openings.hole_of[i] == Openings::kNone &&
                        openings.holes_in(i).empty() &&
                        shape.area <= kDeep * openings.piece_area[openings.piece[i]];
    if (!is_cut) filling.doubtful_area += area;
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
