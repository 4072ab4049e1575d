// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/anatomy/surfaces/repair_steps.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"

namespace artus {
namespace {

using FacePairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// The mesh without the faces of `pairs` and `rings` rings of faces around them.
SurfaceMesh without(const SurfaceMesh& mesh, const FacePairs& pairs, int rings) {
  std::vector<bool> keep(mesh.triangles.size(), true);
  for (const auto& [a, b] : pairs) keep[a] = keep[b] = false;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<bool> near(mesh.vertices.size(), false);
    for (std::size_t f = 0; f < keep.size(); ++f) {
      if (keep[f]) continue;
      for (const auto v : mesh.triangles[f]) near[v] = true;
    }
    for (std::size_t f = 0; f < keep.size(); ++f) {
      for (const auto v : mesh.triangles[f]) keep[f] = keep[f] && !near[v];
    }
  }
  return keep_faces(mesh, keep);
}

bool close(SurfaceMesh& mesh) {
  constexpr int kMaxRounds = 4;
  drop_fragments(mesh);
  for (int round = 0; round < kMaxRounds; ++round) {
    const std::size_t split = split_pinches(mesh);
    if (fill_holes(mesh).n == 0 && split == 0) break;
  }
  drop_pillows(mesh);
  const auto edges = count_edges(mesh);
  return !mesh.triangles.empty() && edges.open == 0 && edges.non_manifold == 0;
}

}  // namespace

bool cut_out_tangles(SurfaceMesh& mesh) {
  constexpr double kVolumeChange = 0.01;
  constexpr int kMaxRounds = 24;
  constexpr int kWidestRing = 5;
  const double volume = signed_volume(mesh);
  SurfaceMesh best = mesh;
  FacePairs pairs = find_self_intersections(best);
  int rings = 0;
  for (int round = 0; round < kMaxRounds && !pairs.empty() && rings <= kWidestRing; ++round) {
    SurfaceMesh trial = without(best, pairs, rings);
    FacePairs left;
    const bool better =
        close(trial) &&
        std::abs(signed_volume(trial) - volume) <= kVolumeChange * std::abs(volume) &&
        (left = find_self_intersections(trial)).size() < pairs.size();
    if (!better) {
      ++rings;
      continue;
    }
    best = std::move(trial);
    pairs = std::move(left);
    rings = 0;
  }
  if (!pairs.empty()) return false;
  mesh = std::move(best);
  return true;
}

}  // namespace artus
