// SPDX-License-Identifier: AGPL-3.0-or-later
#include "raycast/scene.h"

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/layered_body.h"

namespace artus {
namespace {

using test::FlatLayer;
using test::SphereLayer;
using ::testing::ElementsAre;

const Vec3 kFarOrigin(-0.18, -0.05, 1.32);

Scene make_scene(const CompiledJoint& joint) {
  return Scene(std::make_shared<const CompiledJoint>(joint));
}

CompiledJoint make_slab() {
  const std::array<FlatLayer, 3> layers{{{"skin", 0.002}, {"fat", 0.008}, {"muscle", 0.03}}};
  return test::make_layered_block(layers, 0.1, 0.08, kFarOrigin);
}

std::vector<RegionId> regions_of(const std::vector<TissueInterval>& intervals) {
  std::vector<RegionId> regions;
  for (const TissueInterval& interval : intervals) regions.push_back(interval.region);
  return regions;
}

TEST(FindIntervals, CutsALineThroughASlabAtItsLayers) {
  const Scene scene = make_scene(make_slab());
  const Vec3 start = kFarOrigin + Vec3(0.0123, 0.0071, -0.01);
  const auto intervals = tissue_intervals(scene, {start, start + Vec3(0, 0, 0.1)});
  ASSERT_THAT(regions_of(intervals), ElementsAre(0, 2, 3, 4, 0));
  const std::array<double, 6> expected{0, 0.01, 0.012, 0.02, 0.05, 0.1};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(intervals[i].entry, expected[i], 1e-12);
    EXPECT_NEAR(intervals[i].exit, expected[i + 1], 1e-12);
  }
  EXPECT_EQ(intervals[0].entry_normal, Vec3::Zero());
  EXPECT_LT((intervals[2].entry_normal - Vec3(0, 0, -1)).norm(), 1e-12);
}

}  // namespace
}  // namespace artus
