// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/structure_search.h"

#include <array>

#include <gtest/gtest.h>

#include "artus/detail/training/player.h"

namespace artus {
namespace {

/// Muscle of 60 mm with a nerve at x = 10, an artery below a bone at x = -10 mm, y = 0.
std::shared_ptr<const Scene> make_block() {
  GelBlock gel;
  gel.layers = {{"muscle", 60e-3}};
  gel.balls = {{"nerve", Vec3(10e-3, 0, 15e-3), 4e-3},
               {"bone", Vec3(-10e-3, 0, 12e-3), 5e-3},
               {"artery", Vec3(-10e-3, 0, 25e-3), 3e-3}};
  return *make_gel_scene(gel);
}

class StructureSearchTest : public ::testing::Test {
 protected:
  [[nodiscard]] StructureSight see(const char* name, const Vec3& p, double depth = 40e-3) const {
    return see_structure(*scene_, probe_, depth, at(p), region_named(scene_->joint(), name));
  }
  [[nodiscard]] static Pose at(const Vec3& p) { return make_pose(p, Vec3::UnitZ(), Vec3::UnitX()); }
  std::shared_ptr<const Scene> scene_ = make_block();
  Transducer probe_;
};

TEST_F(StructureSearchTest, IsSeenWhereItLiesInThePicture) {
  const StructureSight sight = see("nerve", Vec3::Zero());
  ASSERT_TRUE(sight.in_picture);
  EXPECT_NEAR(sight.x, 10e-3, 1.1e-3);  // lines are 2 mm apart
  EXPECT_NEAR(see("nerve", Vec3(6e-3, 0, 0)).x, 4e-3, 1.1e-3);
}

TEST_F(StructureSearchTest, IsNotSeenBesideThePlaneBelowThePictureInAShadowOrThroughAir) {
  EXPECT_TRUE(see("nerve", Vec3(0, 3.5e-3, 0)).in_picture);
  EXPECT_FALSE(see("nerve", Vec3(0, 4.5e-3, 0)).in_picture);
  EXPECT_FALSE(see("nerve", Vec3::Zero(), 10e-3).in_picture);
  EXPECT_TRUE(see("bone", Vec3(-10e-3, 0, 0)).in_picture);
  EXPECT_FALSE(see("artery", Vec3(-10e-3, 0, 0)).in_picture) << "in the bone's shadow";
  EXPECT_TRUE(see("nerve", Vec3(0, 0, -4e-3)).in_picture) << "gel of 4 mm";
  EXPECT_FALSE(see("nerve", Vec3(0, 0, -8e-3)).in_picture) << "air";
}

TEST_F(StructureSearchTest, IsFoundInTurnWhenItRestsInTheMiddle) {
  const std::array<std::string, 2> names{"nerve", "bone"};
  StructureSearch search(scene_->joint(), names, probe_, 40e-3);
  double time = 0;
  const auto hold = [&](double x, double seconds) {
    for (const double end = time + seconds; time < end; time += 0.05)
      search.look(*scene_, time, at(Vec3(x, 0, 0)));
  };
  hold(-10e-3, 3);
  EXPECT_EQ(search.found(), 0U) << "the bone is not asked for yet";
  hold(0, 3);
  EXPECT_EQ(search.found(), 0U) << "10 mm beside the middle";
  hold(10e-3, 1.3);
  hold(30e-3, 0.2);
  hold(10e-3, 1.3);
  EXPECT_EQ(search.found(), 0U) << "never for 1.5 s on end";
  hold(10e-3, 0.4);
  EXPECT_EQ(search.found(), 1U);
  EXPECT_NEAR(search.sought()[0].found, 7.5 + 1.5, 0.06 + 0.05 * 5);
  EXPECT_GT(search.sought()[0].seen, 5);
  EXPECT_LT(search.sought()[1].found, 0);
  hold(-10e-3, 2);
  EXPECT_TRUE(search.done());
}

TEST_F(StructureSearchTest, WhatTheJointLacksIsNeverFound) {
  const std::array<std::string, 1> names{"liver"};
  StructureSearch search(scene_->joint(), names, probe_, 40e-3);
  for (int i = 0; i < 100; ++i) search.look(*scene_, 0.05 * i, at(Vec3::Zero()));
  EXPECT_FALSE(search.done());
}

}  // namespace
}  // namespace artus
