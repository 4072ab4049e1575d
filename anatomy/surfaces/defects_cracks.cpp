// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/defects_cracks.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "artus/detail/anatomy/surfaces/vertex_sets.h"

namespace artus {
namespace {

constexpr std::uint32_t kNoFan = std::numeric_limits<std::uint32_t>::max();

/// Per vertex the length of its shortest open edge, m; infinite for vertices that have none.
std::vector<double> shortest_open_edge(const SurfaceMesh& mesh, const std::vector<EdgeUse>& uses) {
  std::vector<double> shortest(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first != 1) return;
    const double length = (mesh.vertices[first->lo] - mesh.vertices[first->hi]).norm();
    shortest[first->lo] = std::min(shortest[first->lo], length);
    shortest[first->hi] = std::min(shortest[first->hi], length);
  });
  return shortest;
}

bool are_joined(const std::vector<EdgeUse>& uses, std::uint32_t a, std::uint32_t b) {
  const auto key = std::minmax(a, b);
  const auto it =
      std::lower_bound(uses.begin(), uses.end(), key,
                       [](const EdgeUse& u, const std::pair<std::uint32_t, std::uint32_t>& k) {
                         return std::tie(u.lo, u.hi) < std::tie(k.first, k.second);
                       });
  return it != uses.end() && it->lo == key.first && it->hi == key.second;
}

std::size_t corner_of(const Triangle& t, std::uint32_t v) {
  return t[0] == v ? 0 : (t[1] == v ? 1 : 2);
}

}  // namespace

std::vector<CrackPair> find_crack_pairs(const SurfaceMesh& mesh, const std::vector<EdgeUse>& uses,
                                        double width) {
  const auto shortest = shortest_open_edge(mesh, uses);
  std::vector<std::uint32_t> open;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (shortest[v] < std::numeric_limits<double>::infinity()) open.push_back(v);
  std::sort(open.begin(), open.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(mesh.vertices[a].x(), a) < std::pair(mesh.vertices[b].x(), b);
  });
  std::vector<CrackPair> pairs;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Vec3& p = mesh.vertices[open[i]];
    for (std::size_t j = i + 1; j < open.size() && mesh.vertices[open[j]].x() - p.x() <= width;
         ++j) {
      const double d = (mesh.vertices[open[j]] - p).norm();
      if (d > width || d > 0.5 * std::min(shortest[open[i]], shortest[open[j]])) continue;
      if (are_joined(uses, open[i], open[j])) continue;
      pairs.push_back({std::min(open[i], open[j]), std::max(open[i], open[j]), d});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const CrackPair& x, const CrackPair& y) {
    return std::tie(x.distance, x.a, x.b) < std::tie(y.distance, y.a, y.b);
  });
  return pairs;
}

std::vector<std::uint32_t> find_pinches(const SurfaceMesh& mesh, const std::vector<EdgeUse>& uses) {
  VertexSets fans(3 * mesh.triangles.size());
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    for (const EdgeUse* u = first + 1; u < last; ++u)
      for (const auto v : {first->lo, first->hi})
        fans.union_set(std::size_t{3} * first->face + corner_of(mesh.triangles[first->face], v),
                       std::size_t{3} * u->face + corner_of(mesh.triangles[u->face], v));
  });
  std::vector<std::uint32_t> fan_of(mesh.vertices.size(), kNoFan);
  std::vector<bool> is_pinch(mesh.vertices.size(), false);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = mesh.triangles[f][k];
      const auto fan = static_cast<std::uint32_t>(fans.find_set(3 * f + k));
      if (fan_of[v] == kNoFan)
        fan_of[v] = fan;
      else if (fan_of[v] != fan)
        is_pinch[v] = true;
    }
  }
  std::vector<std::uint32_t> pinches;
  for (std::uint32_t v = 0; v < is_pinch.size(); ++v)
    if (is_pinch[v]) pinches.push_back(v);
  return pinches;
}

}  // namespace artus
