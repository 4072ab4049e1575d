// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <set>

#include "artus/detail/anatomy/surfaces/repair_steps.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "artus/detail/anatomy/surfaces/vertex_sets.h"

namespace artus {
namespace {

bool has_area(const SurfaceMesh& mesh, const Triangle& t) {
  for (const auto v : t)
    if (v >= mesh.vertices.size() || !mesh.vertices[v].allFinite()) return false;
  const Vec3 u = mesh.vertices[t[1]] - mesh.vertices[t[0]];
  const Vec3 v = mesh.vertices[t[2]] - mesh.vertices[t[0]];
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
  return u.cross(v).norm() > 1e-9 * longest;
}

std::size_t keep_and_count(SurfaceMesh& mesh, const std::vector<bool>& keep) {
  const std::size_t before = mesh.triangles.size();
  if (std::find(keep.begin(), keep.end(), false) != keep.end()) mesh = keep_faces(mesh, keep);
  return before - mesh.triangles.size();
}

/// A shred has less than this share of the whole area.
constexpr double kSmallShare = 1e-3;

/// A part of a surface that no edge of two faces joins to the rest.
struct Leaf {
  double area = 0;
  bool is_open = false;        ///< has a side of its own that nothing joins
  bool touches_crowd = false;  ///< hangs on an edge of more than two faces
};

std::size_t drop_outer_flaps(SurfaceMesh& mesh) {
  const auto uses = make_edge_uses(mesh);
  VertexSets leaves(mesh.triangles.size());
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 2) leaves.union_set(first->face, (first + 1)->face);
  });
  std::vector<Leaf> leaf(mesh.triangles.size());  // at the face that stands for all of its leaf
  for (std::size_t f = 0; f < leaf.size(); ++f) {
    leaf[leaves.find_set(f)].area += triangle_area(mesh, mesh.triangles[f]);
  }
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    for (const EdgeUse* u = first; u != last; ++u) {
      Leaf& l = leaf[leaves.find_set(u->face)];
      l.is_open = l.is_open || last - first == 1;
      l.touches_crowd = l.touches_crowd || last - first > 2;
    }
  });
  const double small = kSmallShare * surface_area(mesh);
  std::size_t n = 0;
  std::vector<bool> keep(mesh.triangles.size());
  for (std::size_t f = 0; f < keep.size(); ++f) {
    const std::size_t own = leaves.find_set(f);
    keep[f] = !(leaf[own].is_open && leaf[own].touches_crowd && leaf[own].area < small);
    if (!keep[f] && own == f) ++n;
  }
  keep_and_count(mesh, keep);
  return n;
}

}  // namespace

std::size_t drop_flaps(SurfaceMesh& mesh) {
  std::size_t n = 0;
  for (std::size_t more = drop_outer_flaps(mesh); more > 0; more = drop_outer_flaps(mesh))
    n += more;
  return n;
}

std::size_t drop_bad_faces(SurfaceMesh& mesh) {
  std::set<Triangle> seen;
  std::vector<bool> keep(mesh.triangles.size());
  for (std::size_t f = 0; f < keep.size(); ++f) {
    Triangle key = mesh.triangles[f];
    std::sort(key.begin(), key.end());
    keep[f] = has_area(mesh, mesh.triangles[f]) && seen.insert(key).second;
  }
  return keep_and_count(mesh, keep);
}

std::size_t drop_pillows(SurfaceMesh& mesh) {
  const auto uses = make_edge_uses(mesh);
  const auto pieces = find_pieces(mesh, uses);
  const auto measures = measure_pieces(mesh, uses, pieces);
  std::vector<bool> keep(mesh.triangles.size());
  for (std::size_t f = 0; f < keep.size(); ++f) keep[f] = !measures[pieces.of_face[f]].is_pillow();
  keep_and_count(mesh, keep);
  return static_cast<std::size_t>(std::count_if(
      measures.begin(), measures.end(), [](const PieceMeasure& m) { return m.is_pillow(); }));
}

std::size_t drop_fragments(SurfaceMesh& mesh) {
  const auto uses = make_edge_uses(mesh);
  const auto pieces = find_pieces(mesh, uses);
  const auto measures = measure_pieces(mesh, uses, pieces);
  const double area = surface_area(mesh);
  const auto is_fragment = [&](const PieceMeasure& m) {
    return !m.is_closed && (m.area < kSmallShare * area) && (m.is_sheet() || m.n_faces < 4);
  };
  std::vector<bool> keep(mesh.triangles.size());
  for (std::size_t f = 0; f < keep.size(); ++f) keep[f] = !is_fragment(measures[pieces.of_face[f]]);
  keep_and_count(mesh, keep);
  return static_cast<std::size_t>(std::count_if(measures.begin(), measures.end(), is_fragment));
}

}  // namespace artus
