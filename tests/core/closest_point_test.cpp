// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/closest_point.h"

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

const std::array<Vec3, 3> kCorners{Vec3::Zero(), Vec3(2, 0, 0), Vec3(0, 1, 0)};

TEST(ClosestPoint, IsTheFootTheEdgeOrTheCorner) {
  const auto at = [](const Vec3& p) {
    return closest_point_on_triangle(p, kCorners);
  };
  EXPECT_TRUE(at(Vec3(0.5, 0.25, 3)).isApprox(Vec3(0.5, 0.25, 0))) << "the foot";
  EXPECT_TRUE(at(Vec3(1, -2, 1)).isApprox(Vec3(1, 0, 0))) << "an edge";
  EXPECT_TRUE(at(Vec3(2, 2, 0)).isApprox(Vec3(1.2, 0.4, 0))) << "the long edge";
  EXPECT_TRUE(at(Vec3(3, -1, 1)).isApprox(Vec3(2, 0, 0))) << "a corner";
  EXPECT_EQ(at(Vec3(-1, -1, 5)), Vec3::Zero());
}

TEST(ClosestPoint, IsNoFartherThanAnyPointOfTheTriangle) {
  for (std::uint64_t i = 0; i < 300; ++i) {
    const auto noise = [i](std::uint64_t k) {
      return uniform_noise(1, 8 * i + k);
    };
    const Vec3 p = 6 * Vec3(noise(0), noise(1), noise(2)) - Vec3::Constant(2);
    const double found = (p - closest_point_on_triangle(p, kCorners)).norm();
    for (int a = 0; a <= 20; ++a)
      for (int b = 0; a + b <= 20; ++b) {
        const Vec3 q = kCorners[0] + a / 20.0 * (kCorners[1] - kCorners[0]) +
                       b / 20.0 * (kCorners[2] - kCorners[0]);
        ASSERT_LE(found, (p - q).norm() + 1e-12);
      }
  }
}

TEST(ClosestPoint, OfATriangleWithoutAreaIsOnItsSegment) {
  const std::array<Vec3, 3> flat{Vec3::Zero(), Vec3(2, 0, 0), Vec3(1, 0, 0)};
  EXPECT_TRUE(closest_point_on_triangle(Vec3(0.5, 3, 0), flat).isApprox(Vec3(0.5, 0, 0)));
  const std::array<Vec3, 3> point{Vec3::UnitX(), Vec3::UnitX(), Vec3::UnitX()};
  EXPECT_TRUE(closest_point_on_triangle(Vec3::Zero(), point).isApprox(Vec3::UnitX()));
}

}  // namespace
}  // namespace artus
