// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/cage.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

bool keep_all(const Vec3&, double) {
  return true;
}

CageParams graded_box() {
  CageParams params;
  params.high = Vec3(0.048, 0.036, 0.024);
  params.cell = 0.012;
  params.zones.push_back({Vec3(0.02, 0.01, 0), Vec3(0.024, 0.014, 0.002), 0.0015});
  return params;
}

TEST(Cage, CellsFillTheBoxOnce) {
  const Cage cage(graded_box(), keep_all);
  double volume = 0;
  for (const CageCell& cell : cage.cells()) volume += std::pow(cage.edge(cell), 3);
  EXPECT_NEAR(volume, 0.048 * 0.036 * 0.024, 1e-15);
}

TEST(Cage, NeighboursDifferByAFactorOfTwoAtMost) {
  const Cage cage(graded_box(), keep_all);
  for (const CageCell& cell : cage.cells()) {
    const double edge = cage.edge(cell);
    for (int k = 0; k < 27; ++k) {
      const Vec3 side = Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1) * (0.5 * edge + 1e-6);
      const CagePlace place =
          cage.locate(cage.low_corner(cell) + Vec3::Constant(0.5 * edge) + side);
      if (place.cell < 0) continue;
      EXPECT_LE(cage.edge(cage.cells()[static_cast<std::size_t>(place.cell)]), 2 * edge + 1e-12);
    }
  }
}

TEST(Cage, DisplacementHasNoGapsAcrossHangingNodes) {
  const Cage cage(graded_box(), keep_all);
  std::vector<Vec3> u(cage.nodes().size());
  std::size_t hanging = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
    u[n] = Vec3(uniform_noise(1, n), uniform_noise(2, n), uniform_noise(3, n));
  for (std::uint32_t n = 0; n < u.size(); ++n) {
    if (cage.masters(n).empty()) continue;
    ++hanging;
    u[n].setZero();
    double sum = 0;
    for (const NodeShare& s : cage.masters(n)) {
      EXPECT_TRUE(cage.masters(s.node).empty());
      u[n] += s.weight * u[s.node];
      sum += s.weight;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
  EXPECT_GT(hanging, 50U);
  const auto at = [&](const Vec3& p) {
    const CagePlace place = cage.locate(p);
    Vec3 d = Vec3::Zero();
    for (std::size_t a = 0; a < 8; ++a)
      d += place.weights[a] * u[cage.cells()[static_cast<std::size_t>(place.cell)].nodes[a]];
    return d;
  };
  // Across every lattice plane: the same from both sides.
  for (int k = 0; k < 4000; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    Vec3 p(0.048 * uniform_noise(4, i), 0.036 * uniform_noise(5, i), 0.024 * uniform_noise(6, i));
    const int axis = k % 3;
    p[axis] = 0.0015 * std::clamp(std::round(p[axis] / 0.0015), 1.0, 15.0);
    Vec3 e = Vec3::Zero();
    e[axis] = 1e-10;
    EXPECT_LT((at(p - e) - at(p + e)).norm(), 1e-5);
  }
}

TEST(Cage, PointOutsideIsGivenTheNearestCellInReach) {
  const Cage cage(graded_box(), keep_all);
  EXPECT_EQ(cage.locate(Vec3(0.02, 0.02, -1e-3)).cell, -1);
  const CagePlace place = cage.locate(Vec3(0.02, 0.02, -1e-3), 2);
  ASSERT_GE(place.cell, 0);
  double above = 0;
  for (std::size_t a = 0; a < 4; ++a) above += place.weights[a];
  EXPECT_NEAR(above, 1, 1e-12);
  EXPECT_EQ(cage.locate(Vec3(0, 0, std::nan("")), 2).cell, -1);
}

TEST(Cage, AnEmptyBoxIsRefused) {
  CageParams params;
  EXPECT_THROW(Cage(params, keep_all), std::invalid_argument);
}

}  // namespace
}  // namespace artus
