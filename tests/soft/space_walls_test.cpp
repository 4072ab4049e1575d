// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/space_walls.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

/// Two tetrahedra of 1/6 and 2/6 m^3 on either side of a face they share: regions 2 and 3.
TetMesh two_tetrahedra() {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -2}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  mesh.regions = {2, 3};
  mesh.interfaces = {{{0, 1, 2}, 2, 3},        {{0, 1, 3}, kOutside, 2}, {{1, 2, 3}, kOutside, 2},
                     {{0, 2, 3}, 2, kOutside}, {{1, 0, 4}, kOutside, 3}, {{2, 1, 4}, kOutside, 3},
                     {{2, 0, 4}, 3, kOutside}};
  return mesh;
}

double volume_of(const TetMesh& mesh, const std::vector<bool>& regions) {
  return volume_within(walls_of(mesh, regions), mesh.vertices);
}

TEST(SpaceWalls, HoldTheVolumeOfTheirTetrahedraHoweverTheirInterfacesAreWound) {
  const TetMesh mesh = two_tetrahedra();
  EXPECT_NEAR(volume_of(mesh, {false, false, true}), tet_volume(mesh, 0), 1e-15);
  EXPECT_NEAR(volume_of(mesh, {false, false, false, true}), tet_volume(mesh, 1), 1e-15);
}

TEST(SpaceWalls, OfTwoRegionsTogetherLeaveOutWhatTheyShare) {
  const TetMesh mesh = two_tetrahedra();
  const std::vector<bool> both{false, false, true, true};
  EXPECT_EQ(walls_of(mesh, both).size(), 6U);
  EXPECT_NEAR(volume_of(mesh, both), 0.5, 1e-15);
}

TEST(SpaceWalls, HoldTheSameSeenFromAnywhere) {
  const TetMesh mesh = two_tetrahedra();
  const auto walls = walls_of(mesh, {false, false, true});
  EXPECT_NEAR(volume_within(walls, mesh.vertices, {7, -3, 5}), 1.0 / 6, 1e-13);
}

TEST(SpaceWalls, OfNoRegionAreNone) {
  EXPECT_TRUE(walls_of(two_tetrahedra(), {}).empty());
}

}  // namespace
}  // namespace artus
