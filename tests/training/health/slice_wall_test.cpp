// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/slice_wall.h"

#include <gtest/gtest.h>

#include "artus/detail/training/health/beam_walls.h"

namespace artus {
namespace {

constexpr RegionId kSpace = kFirstRegion;

/// A wall of a space across the plane y = 0, from one place in it to another.
TetMesh wall_between(const Vec3& from, const Vec3& to) {
  TetMesh mesh;
  const Vec3 aside(0, 5e-3, 0);
  mesh.vertices = {from - aside, to - aside, to + aside, from + aside};
  mesh.interfaces = {{{0, 1, 2}, kSpace, kOutside}, {{0, 2, 3}, kSpace, kOutside}};
  return mesh;
}

TEST(SliceWall, IsAsLongAsItWas) {
  std::vector<bool> regions(kSpace + 1, false);
  regions[kSpace] = true;
  const Transducer transducer;
  const Transducer even = spaced_evenly(transducer);
  // Between the hundredth beam and the next, along them, where it lay across them before.
  const Vec3 top = scanline(even, 100).origin + Vec3(0.4 * kBeamSpacing, 0, 10e-3);
  const TetMesh after = wall_between(top, top + Vec3(0, 0, 4e-3));
  const TetMesh turned = wall_between(top, top + Vec3(2.5e-3, 0, 0));
  const SliceWall wall(turned, after, regions, Pose::Identity(), transducer);
  EXPECT_NEAR(wall.length_before(100, 10e-3, 14e-3), 2.375e-3, 1e-9);
  EXPECT_NEAR(wall.length_before(100, 9e-3, 12e-3 + kBeamSpacing / 2), 1.25e-3, 1e-9);
  EXPECT_EQ(wall.length_before(101, 10e-3, 14e-3), 0);
  EXPECT_EQ(wall.length_before(99, 10e-3, 14e-3), 0);
  // Walls that jump there do so as far as the wall had not been there.
  const BeamWalls before(even.n_lines);
  BeamWalls jumps(before.size());
  for (std::size_t i = 0; i < jumps.size(); ++i) jumps[i] = {{i > 100 ? 10e-3 : 14e-3, 20e-3}};
  EXPECT_NEAR(find_wall_jump(before, jumps).jump, 4e-3, 1e-9);
  EXPECT_EQ(find_wall_jump(before, jumps, &wall).jump, 0);
  const TetMesh ledge = wall_between(top, top + Vec3(0.2e-3, 0, 0));
  const SliceWall cut(ledge, after, regions, Pose::Identity(), transducer);
  EXPECT_NEAR(find_wall_jump(before, jumps, &cut).jump, 4e-3, 1e-9);
  TetMesh other = after;
  other.interfaces.pop_back();
  EXPECT_EQ(SliceWall(other, after, regions, Pose::Identity(), transducer)
                .length_before(100, 10e-3, 14e-3),
            0);
}

}  // namespace
}  // namespace artus
