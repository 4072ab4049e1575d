// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/overflow.h"

#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/body/find_region.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

double total(const std::vector<Injected>& places) {
  return std::accumulate(places.begin(), places.end(), 0.0,
                         [](double sum, const Injected& p) { return sum + p.volume; });
}

class Overflow : public ::testing::Test {
 protected:
  void SetUp() override {
    auto joint = read_compiled_joint(test::test_joints() / "shoulder.artus");
    ASSERT_TRUE(joint);
    joint_ = std::make_shared<const CompiledJoint>(std::move(*joint));
    spaces_ = std::make_unique<const OpenedSpaces>(joint_);
    const auto region = find_region(*joint_, "joint_fluid");
    ASSERT_TRUE(region);
    region_ = *region;
    for (std::size_t t = 0; t < joint_->mesh.tetrahedra.size(); ++t)
      if (joint_->mesh.regions[t] == region_) {
        tip_ = Vec3::Zero();
        for (const std::uint32_t v : joint_->mesh.tetrahedra[t])
          tip_ += joint_->mesh.vertices[v] / 4;
        break;
      }
  }
  std::shared_ptr<const CompiledJoint> joint_;
  std::unique_ptr<const OpenedSpaces> spaces_;
  RegionId region_ = kOutside;
  Vec3 tip_ = Vec3::Zero();
};

TEST_F(Overflow, LeavesWhatASpaceTakes) {
  const double most = spaces_->of(region_).max_volume();
  const auto places = with_overflow(*spaces_, {{"joint_fluid", 0.9 * most, true, tip_}});
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(places[0].volume, 0.9 * most);
}

TEST_F(Overflow, GivesWhatIsTooMuchToSoftTissueBesideTheSpace) {
  const double most = spaces_->of(region_).max_volume();
  const auto places = with_overflow(
      *spaces_, {{"joint_fluid", 0.7 * most, true, tip_}, {"joint_fluid", 0.7 * most, true, tip_}});
  ASSERT_EQ(places.size(), 3U);
  EXPECT_EQ(places[0].volume, 0.7 * most);
  EXPECT_NEAR(places[1].volume, 0.3 * most, 1e-15);
  EXPECT_FALSE(places[2].cavity);
  EXPECT_NEAR(total(places), 1.4 * most, 1e-15);
  const auto beside = find_region(*joint_, places[2].region);
  ASSERT_TRUE(beside);
  EXPECT_FALSE(joint_->tissue_of(*beside).haptic.hard);
  const CompiledJoint with = with_injected(*joint_, places, Liquid{}, {}, *spaces_);
  EXPECT_TRUE(find_region(with, "injected").has_value());
}

TEST_F(Overflow, IsThereOnlyOnce) {
  const double most = spaces_->of(region_).max_volume();
  const auto once = with_overflow(*spaces_, {{"joint_fluid", 2 * most, true, tip_}});
  const auto twice = with_overflow(*spaces_, once);
  ASSERT_EQ(once.size(), twice.size());
  for (std::size_t k = 0; k < once.size(); ++k) EXPECT_EQ(once[k].volume, twice[k].volume);
}

}  // namespace
}  // namespace artus
