// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/tet_locator.h"

#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

constexpr double kNear = 1e-9;  // of an edge: what rounding may decide

/// Barycentric coordinates, by a solver.
Eigen::Vector4d weights_of(const TetMesh& mesh, std::size_t tet, const Vec3& p) {
  Eigen::Matrix4d corners;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    corners.col(column).head<3>() = mesh.vertices[mesh.tetrahedra[tet][k]];
    corners(3, column) = 1;
  }
  Eigen::Vector4d right;
  right << p, 1;
  return corners.fullPivLu().solve(right);
}

/// The first tetrahedron that holds the point, by trying all; -1: none.
std::int64_t first_of(const TetMesh& mesh, const Vec3& p) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (weights_of(mesh, t, p).minCoeff() >= -kNear) return static_cast<std::int64_t>(t);
  }
  return -1;
}

class TetLocatorTest : public testing::Test {
 protected:
  const std::array<FlatLayer, 2> layers{{{"fat", 8e-3}, {"muscle", 12e-3}}};
  const CompiledJoint block = test::make_meshed_block(layers, 0.02, 0.016, 4e-3);
  const TetMesh& mesh = block.mesh;
  const TetLocator locator{mesh, 1.7e-3};  // boxes that no face lies along
};

TEST_F(TetLocatorTest, FindsWhatTryingAllFinds) {
  int inside = 0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const Vec3 p(0.024 * (uniform_noise(1, i) - 0.5), 0.02 * (uniform_noise(2, i) - 0.5),
                 0.024 * uniform_noise(3, i) - 2e-3);
    const std::int64_t expected = first_of(mesh, p);
    EXPECT_EQ(locator.find(p), expected) << p.transpose();
    if (expected >= 0) ++inside;
  }
  EXPECT_GT(inside, 150);
  EXPECT_LT(inside, 350);
}

TEST_F(TetLocatorTest, FindsOneThatHoldsWhatLiesOnCornersEdgesAndFaces) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); t += 7) {
    const auto& [a, b, c, d] = mesh.tetrahedra[t];
    const auto& v = mesh.vertices;
    for (const Vec3& p : {v[a], Vec3((v[a] + v[b]) / 2), Vec3((v[b] + v[c] + v[d]) / 3)}) {
      const std::int64_t found = locator.find(p);
      ASSERT_GE(found, 0) << p.transpose();
      EXPECT_GE(weights_of(mesh, static_cast<std::size_t>(found), p).minCoeff(), -1e-8);
    }
  }
}

TEST_F(TetLocatorTest, AnswersTheSameWithBoxesOfAnySize) {
  const TetLocator coarse(mesh, 30e-3);
  const TetLocator fine(mesh, 0.6e-3);
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const Vec3 p(0.02 * (uniform_noise(4, i) - 0.5), 0.016 * (uniform_noise(5, i) - 0.5),
                 0.02 * uniform_noise(6, i));
    EXPECT_EQ(fine.find(p), coarse.find(p)) << p.transpose();
    EXPECT_EQ(locator.find(p), coarse.find(p)) << p.transpose();
  }
}

TEST_F(TetLocatorTest, FindsNothingWhereThereIsNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& p : {Vec3(0, 0, -1e-3), Vec3(0, 0, 1), Vec3(1e9, 0, 0), Vec3(0, nan, 0.01)})
    EXPECT_EQ(locator.find(p), -1) << p.transpose();
  EXPECT_THROW(TetLocator(TetMesh{}), std::invalid_argument);
}

}  // namespace
}  // namespace artus
