// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/bevel.h"

#include <array>
#include <numeric>

#include <gtest/gtest.h>

#include "artus/detail/haptics/needle/needle_tick_step.h"
#include "artus/haptics/needle_feel.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

TEST(Bevel, IsInTheLayersThatItsOpeningIsIn) {
  const std::array<test::FlatLayer, 3> layers{
      {{"skin", 2e-3}, {"muscle", 10e-3}, {"tendon", 10e-3}}};
  const auto joint =
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 0.1, 0.1));
  const Scene scene(joint);
  NeedleTickStep tick(make_layer_table(*joint, {}), {});
  std::vector<std::uint32_t> of_region(joint->regions.size());
  std::iota(of_region.begin(), of_region.end(), 10U);
  const auto muscle = of_region[test::region_named(*joint, "muscle")];
  const auto tendon = of_region[test::region_named(*joint, "tendon")];
  const double bevel = 1e-3;
  double half = -1;
  for (int k = 0; k < 20000; ++k) {
    const double depth = -5e-3 + 1e-6 * k;
    TimedPose pose;
    pose.X_JN = make_pose(Vec3(0, 0, depth), Vec3::UnitZ(), Vec3::UnitX());
    pose.time = 1e-3 * k;
    tick.step(pose, scene);
    const auto shares = bevel_shares(tick.model().contact(), bevel, of_region);
    ASSERT_NEAR(shares[0].share + shares[1].share, 1, 1e-12);
    if (depth < 0) {
      EXPECT_EQ(shares[0].space, of_region[kOutside]);
    }
    if (depth > 4e-3 && depth < 11e-3) {
      EXPECT_EQ(shares[0].space, muscle);
      EXPECT_EQ(shares[0].share, 1);
    }
    if (depth > 12e-3 && depth < 12.999e-3) {
      EXPECT_EQ(shares[0].space, tendon);
      EXPECT_EQ(shares[1].space, muscle);
      EXPECT_NEAR(shares[0].share, (depth - 12e-3) / bevel, 1e-5);
      half = shares[0].share;
    }
  }
  EXPECT_GT(half, 0.9);
}

}  // namespace
}  // namespace artus
