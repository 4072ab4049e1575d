// SPDX-License-Identifier: AGPL-3.0-or-later
// Dihedral angles of tetrahedra that everybody knows.
#include "artus/detail/anatomy/compile/labels/quality.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "tests/anatomy/compile/tet_samples.h"

namespace artus {
namespace {

const std::array<Vec3, 4> kCorner{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};

TEST(DihedralRange, OfTheRegularTetrahedronIsArcCosineOfOneThird) {
  const auto [low, high] =
      dihedral_range_deg({Vec3(1, 1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1), Vec3(-1, -1, 1)});
  EXPECT_NEAR(low, std::acos(1.0 / 3) / kDegree, 1e-10);
  EXPECT_NEAR(high, low, 1e-10);
}

TEST(DihedralRange, OfACubesCornerIsThatOfItsFacesAndItsCut) {
  const auto [low, high] = dihedral_range_deg(kCorner);
  EXPECT_NEAR(low, std::acos(1 / std::sqrt(3.0)) / kDegree, 1e-10);
  EXPECT_NEAR(high, 90, 1e-10);
}

TEST(DihedralRange, DoesNotDependOnSizeOrPlace) {
  std::array<Vec3, 4> moved = kCorner;
  const auto turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized());
  for (Vec3& p : moved) p = turn * p * 1e-4 + Vec3(1, 2, 3);
  EXPECT_NEAR(dihedral_range_deg(moved).first, dihedral_range_deg(kCorner).first, 1e-6);
}

TEST(TetQuality, CountsEveryTetrahedronOnceAndFindsTheFlatAndTheInverted) {
  TetMesh mesh;
  mesh.vertices.assign(kCorner.begin(), kCorner.end());
  mesh.vertices.emplace_back(0.3, 0.3, 0.01);  // nearly in the floor
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 2, 1, 3}};
  mesh.regions = {kFirstRegion, kFirstRegion, kFirstRegion};
  const TetQuality quality = compute_quality(mesh);
  std::size_t sum = 0;
  for (const std::size_t n : quality.histogram) sum += n;
  EXPECT_EQ(sum, 3U);
  EXPECT_EQ(quality.below_8_deg, 1U);
  EXPECT_EQ(quality.inverted, 1U);
  EXPECT_NEAR(quality.above_8_deg_percent(), 100 * 2.0 / 3, 1e-12);
  EXPECT_LT(quality.smallest_deg, 8);
  EXPECT_GT(quality.largest_deg, 150);
}

TEST(TetQuality, OfNothingIsGood) {
  EXPECT_EQ(compute_quality({}).above_8_deg_percent(), 100);
}

TEST(TetQuality, OfACubeOfTetrahedraIsThatOfItsCell) {
  const TetMesh mesh = test::make_cube_of_tets(2, 1, [](const Vec3&) { return kFirstRegion; });
  const TetQuality quality = compute_quality(mesh);
  EXPECT_NEAR(quality.smallest_deg, 45, 1e-9);
  EXPECT_NEAR(quality.largest_deg, 90, 1e-9);
  EXPECT_EQ(quality.inverted, 0U);
}

}  // namespace
}  // namespace artus
