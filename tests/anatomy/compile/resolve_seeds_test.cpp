// SPDX-License-Identifier: AGPL-3.0-or-later
// Seeds on the boundaries of a labelling that is known in closed form.
#include "artus/detail/anatomy/compile/labels/resolve_seeds.h"

#include <oneapi/tbb/global_control.h>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kSpacing = 1e-3;  // m
const Box kBox{Vec3::Constant(-0.01), Vec3::Constant(0.01)};

RegionId ball(const Vec3& p) {
  return p.norm() < 7.3e-3 ? kFirstRegion : kOutside;
}

std::vector<BoundarySeed> seeds_of_ball() {
  return find_boundary_seeds(ball, kBox, kSpacing);
}

TEST(BoundarySeeds, LieOnTheBoundaryAndNameBothSides) {
  const auto seeds = seeds_of_ball();
  EXPECT_GT(seeds.size(), 300U);
  for (const BoundarySeed& seed : seeds) {
    EXPECT_NEAR(seed.point.norm(), 7.3e-3, 1e-3 * kSpacing);
    EXPECT_EQ(std::min(seed.from, seed.to), kOutside);
    EXPECT_EQ(std::max(seed.from, seed.to), kFirstRegion);
  }
}

TEST(BoundarySeeds, NoPartThickerThanTheSpacingIsMissed) {
  for (int i = 0; i < 20; ++i) {
    const double z = -5e-3 + 0.37e-3 * i;
    const auto plate = [z](const Vec3& p) -> RegionId {
      return p.z() > z && p.z() < z + 1.01 * kSpacing ? kFirstRegion + 1 : kFirstRegion;
    };
    EXPECT_FALSE(find_boundary_seeds(plate, kBox, kSpacing).empty()) << z;
  }
}

TEST(BoundarySeeds, OfOneRegionAreNone) {
  EXPECT_TRUE(
      find_boundary_seeds([](const Vec3&) { return kFirstRegion; }, kBox, kSpacing).empty());
}

TEST(BoundarySeeds, ComeInTheSameOrderAtAnyNumberOfThreads) {
  const auto many = seeds_of_ball();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const auto one = seeds_of_ball();
  ASSERT_EQ(many.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i) ASSERT_EQ(many[i].point, one[i].point);
}

TEST(ThinSeeds, KeepsTheirDistanceAndLeavesNoGap) {
  const auto seeds = seeds_of_ball();
  constexpr double kApart = 3e-3;
  const auto kept = thin_seeds(
      seeds, [](const BoundarySeed&) { return kApart; }, kApart);
  EXPECT_LT(kept.size(), seeds.size() / 4);
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE((kept[i].point - kept[j].point).norm(), kApart);
  for (const BoundarySeed& seed : seeds) {
    double nearest = 1;
    for (const BoundarySeed& k : kept) nearest = std::min(nearest, (k.point - seed.point).norm());
    EXPECT_LT(nearest, kApart) << "a seed went without another beside it";
  }
}

}  // namespace
}  // namespace artus
