// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <set>

#include "artus/detail/anatomy/surfaces/defects_cracks.h"
#include "artus/detail/anatomy/surfaces/repair_steps.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "artus/detail/anatomy/surfaces/vertex_sets.h"

namespace artus {
namespace {

/// For each vertex the one it becomes: itself, or the least of the vertices it is welded with.
using Welds = std::vector<std::uint32_t>;

/// Welds each vertex with its nearest partner only, unless they coincide: chains would pull a
/// crack's side along itself.
Welds choose_welds(const std::vector<CrackPair>& pairs, const std::vector<bool>& is_barred,
                   std::size_t n_vertices) {
  VertexSets sets(n_vertices);
  std::vector<bool> is_taken(n_vertices, false);
  for (const auto& pair : pairs) {
    if (is_barred[pair.a] || is_barred[pair.b]) continue;
    const bool coincide = pair.distance == 0;
    if (!coincide && (is_taken[pair.a] || is_taken[pair.b])) continue;
    sets.union_set(pair.a, pair.b);
    is_taken[pair.a] = is_taken[pair.b] = true;
  }
  Welds least(n_vertices);
  Welds of_root(n_vertices, static_cast<std::uint32_t>(n_vertices));
  for (std::uint32_t v = 0; v < n_vertices; ++v) {
    auto& root = of_root[sets.find_set(v)];
    root = std::min(root, v);
    least[v] = root;
  }
  return least;
}

Triangle welded(const Triangle& t, const Welds& welds) {
  return {welds[t[0]], welds[t[1]], welds[t[2]]};
}

/// Vertices (before welding) whose weld folded a face or crowded an edge that was not crowded.
std::vector<std::uint32_t> find_culprits(const SurfaceMesh& mesh, const SurfaceMesh& after,
                                         const Welds& welds) {
  std::set<std::uint32_t> bad;
  std::set<Triangle> seen;
  for (const auto& t : after.triangles) {
    Triangle key = t;
    std::sort(key.begin(), key.end());
    if (key[0] == key[1] || key[1] == key[2] || !seen.insert(key).second)
      bad.insert(t.begin(), t.end());
  }
  for_each_edge(make_edge_uses(after), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first > 2) bad.insert({first->lo, first->hi});
  });
  std::vector<std::uint32_t> culprits;
  std::vector<std::uint32_t> n_merged(mesh.vertices.size(), 0);
  for (const std::uint32_t v : welds) ++n_merged[v];
  for (std::uint32_t v = 0; v < welds.size(); ++v)
    if (n_merged[welds[v]] > 1 && bad.contains(welds[v])) culprits.push_back(v);
  return culprits;
}

/// Each welded vertex moves to the mean of those it was made of.
void move_to_means(SurfaceMesh& mesh, const Welds& welds) {
  std::vector<Vec3> sum(mesh.vertices.size(), Vec3::Zero());
  std::vector<double> n(mesh.vertices.size(), 0);
  for (std::size_t v = 0; v < welds.size(); ++v) {
    sum[welds[v]] += mesh.vertices[v];
    n[welds[v]] += 1;
  }
  for (std::size_t v = 0; v < welds.size(); ++v)
    if (n[v] > 1) mesh.vertices[v] = sum[v] / n[v];
}

}  // namespace

std::size_t weld_cracks(SurfaceMesh& mesh, double width) {
  constexpr int kMaxRounds = 20;
  const auto pairs = find_crack_pairs(mesh, make_edge_uses(mesh), width);
  if (pairs.empty()) return 0;
  std::vector<bool> is_barred(mesh.vertices.size(), false);
  for (int round = 0; round < kMaxRounds; ++round) {
    const Welds welds = choose_welds(pairs, is_barred, mesh.vertices.size());
    SurfaceMesh after{mesh.vertices, mesh.triangles};
    for (auto& t : after.triangles) t = welded(t, welds);
    const auto culprits = find_culprits(mesh, after, welds);
    if (culprits.empty()) {
      std::size_t n = 0;
      for (std::uint32_t v = 0; v < welds.size(); ++v) n += welds[v] != v ? 1U : 0U;
      move_to_means(after, welds);
      mesh = keep_faces(after, std::vector<bool>(after.triangles.size(), true));
      return n;
    }
    for (const auto v : culprits) is_barred[v] = true;
  }
  return 0;
}

}  // namespace artus
