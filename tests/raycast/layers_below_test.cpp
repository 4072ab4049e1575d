// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/raycast/layers_below.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/moved_block.h"

namespace artus {
namespace {

test::MovedBlock make_block_over_bone() {
  const std::array<test::FlatLayer, 4> layers{
      {{"skin", 3e-3}, {"fat", 6e-3}, {"bone", 9e-3}, {"muscle", 12e-3}}};
  return test::make_moved_block(layers);
}

Pose face_at(double z) {
  return make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX());
}

TEST(LayersBelow, ThinByTheStrainThatTheTissueHas) {
  const test::MovedBlock block = make_block_over_bone();
  // 20 % in the skin, 5 % in the fat.
  const auto body = block.moved([](const Vec3& p) {
    return Vec3(0, 0, 0.9e-3 - (p.z() < 3e-3 ? 0.2 * p.z() : 0.6e-3 + 0.05 * (p.z() - 3e-3)));
  });
  const auto layers = layers_below(*body, face_at(-2e-3));
  ASSERT_EQ(layers.size(), 2U) << "down to the bone";
  EXPECT_EQ(layers[0].region, region_named(*block.joint, "skin"));
  EXPECT_NEAR(layers[0].rest, 3e-3, 1e-6);
  EXPECT_NEAR(layers[0].now, 2.4e-3, 1e-5);
  EXPECT_NEAR(layers[0].thinned(), 0.2, 0.005);
  EXPECT_EQ(layers[1].region, region_named(*block.joint, "fat"));
  EXPECT_NEAR(layers[1].thinned(), 0.05, 0.005);
}

TEST(LayersBelow, LieAlongTheAxisOfTheFace) {
  const test::MovedBlock block = make_block_over_bone();
  const double tilt = 0.5;
  const Pose X_JP = make_pose(Vec3::Zero(), Vec3(std::sin(tilt), 0, std::cos(tilt)),
                              Vec3(std::cos(tilt), 0, -std::sin(tilt)));
  const auto layers = layers_below(*block.at_rest(), X_JP);
  ASSERT_EQ(layers.size(), 2U);
  EXPECT_NEAR(layers[1].rest, 6e-3 / std::cos(tilt), 1e-6);
  EXPECT_NEAR(layers[1].thinned(), 0, 1e-12);
}

TEST(LayersBelow, AreNoneBesideTheBody) {
  EXPECT_TRUE(layers_below(*make_block_over_bone().at_rest(),
                           make_pose(Vec3(1, 0, 0), Vec3::UnitZ(), Vec3::UnitX()))
                  .empty());
}

}  // namespace
}  // namespace artus
