// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/raycast/scene.h"

/// Slow, plain answers to compare the fast ones with; nothing here shares code with raycast.
namespace artus::test {

/// The segment's crossings by testing every triangle in double precision, sorted by depth. Each
/// edge is judged by one number that its triangles share, so a line passes on one side of an edge
/// for all of them.
[[nodiscard]] std::vector<Crossing> brute_force_crossings(const TetMesh& mesh,
                                                          const Segment& segment);

/// Distance from a point to the nearest triangle by sampling no shortcuts: every triangle, m.
[[nodiscard]] double brute_force_distance(const TetMesh& mesh, const Vec3& p);

/// A conforming, non-manifold complex: an `n` x `n` x `n` lattice of cells of edge `cell` around
/// `centre`, each cell one of `labels` regions picked by `seed`, inner lattice points moved by up
/// to `jitter` of a cell. Three and more regions meet at its edges.
struct CellBody {
  CompiledJoint joint;
  Vec3 low = Vec3::Zero();  ///< the lattice's corner, before jitter
  double cell = 0;
  int n = 0;
  std::vector<RegionId> labels;  ///< (n, n, n), x fastest
  [[nodiscard]] RegionId label(int i, int j, int k) const;
};
[[nodiscard]] CellBody make_cell_body(int n, double cell, const Vec3& centre, int labels,
                                      double jitter, std::uint64_t seed);

/// The stretches longer than `shortest`, as (region, entry); neighbours of one region are joined.
struct Stretch {
  RegionId region = 0;
  double entry = 0;
};
[[nodiscard]] std::vector<Stretch> stretches(const std::vector<TissueInterval>& intervals,
                                             double shortest);
[[nodiscard]] std::vector<Stretch> stretches(const std::vector<Crossing>& crossings, double length,
                                             double shortest);

/// `i`-th point of a deterministic uniform sequence in the cube centre +- half.
[[nodiscard]] Vec3 random_point(std::uint64_t seed, std::uint64_t i, const Vec3& centre,
                                double half);

}  // namespace artus::test
