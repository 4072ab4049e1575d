// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/rest_path.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/moved_block.h"

namespace artus {
namespace {

/// A press that bends lines, 3 mm at the top, with strains up to 20 %.
std::shared_ptr<const DeformedBody> pressed_block() {
  const std::array<FlatLayer, 2> layers{{{"fat", 12e-3}, {"muscle", 36e-3}}};
  return test::make_moved_block(layers).moved([](const Vec3& p) {
    const double fades = std::exp(-p.z() / 15e-3 - p.x() * p.x() / 8e-4);
    return Vec3(0.5e-3 * std::sin(200 * p.x()) * fades, 0, 3e-3 * fades);
  });
}

TEST(RestPath, IsStraightBetweenItsKnotsToEightMicrometres) {
  const auto body = pressed_block();
  for (const double x : {-0.02, -0.003, 0.011}) {
    const Vec3 origin(x, 0.4e-3, 4e-3);
    const Vec3 direction = Vec3(0.1, 0.02, 1).normalized();
    const RestPath path(*body, origin, direction);
    RestKnot left = path.at(0);
    int n = 0;
    for (; left.along < 0.035; ++n) {
      const RestKnot right = path.next(left);
      ASSERT_GT(right.along, left.along);
      for (const double share : {0.25, 0.5, 0.75, 1.0}) {
        const double along = left.along + share * (right.along - left.along);
        const auto exact = body->to_rest(origin + along * direction, left.displacement_J);
        ASSERT_TRUE(exact.found);
        const Vec3 straight = left.rest_J + share * (right.rest_J - left.rest_J);
        EXPECT_LT((straight - exact.p_rest).norm(), 8e-6) << along;
      }
      EXPECT_LT((right.displacement_J - (origin + right.along * direction - right.rest_J)).norm(),
                1e-12);
      left = right;
    }
    EXPECT_LT(n, 60);
  }
}

TEST(RestPath, FindsTheTissueBesideAKnotToTheFirstOrder) {
  const auto body = pressed_block();
  const Vec3 direction = Vec3::UnitZ();
  const RestPath middle(*body, Vec3(4e-3, 0.5e-3, 5e-3), direction);
  const RestPath side(*body, Vec3(4e-3, 1.0e-3, 5e-3), direction);
  const RestKnot knot = side.at(4e-3);
  EXPECT_LT((middle.at(4e-3).beside(knot.rest_J + knot.displacement_J) - knot.rest_J).norm(), 2e-5);
}

TEST(RestPath, OfABodyAtRestIsTheLineItself) {
  const std::array<FlatLayer, 1> layers{{{"muscle", 48e-3}}};
  const auto body = test::make_moved_block(layers).at_rest();
  const RestPath path(*body, Vec3(1e-3, 2e-3, 3e-3), Vec3::UnitZ());
  RestKnot knot = path.at(0);
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(knot.moved, 0);
    EXPECT_EQ(knot.rest_J, Vec3(1e-3, 2e-3, 3e-3 + knot.along));
    knot = path.next(knot);
  }
}

}  // namespace
}  // namespace artus
