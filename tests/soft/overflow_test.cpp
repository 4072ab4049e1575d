// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/overflow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/body/find_region.h"
#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/soft/cage/tet_locator.h"
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

TEST_F(Overflow, SpacesThatAPlanEndsInAreMadeReadyFirst) {
  CompiledJoint joint = *joint_;
  const auto spaces = make_joint_spaces(joint);
  ASSERT_TRUE(spaces);
  const auto space_of = [&](const char* name) {
    return spaces->of_region[*find_region(joint, name)];
  };
  const auto bursa_first = order_by_plan(joint, *spaces);
  ASSERT_GT(bursa_first.size(), 2U);
  EXPECT_EQ(bursa_first.front(), space_of("subacromial_bursa"));
  joint.injections = {{"joint", Vec3::Zero(), tip_}, joint.injections.front()};
  const auto joint_first = order_by_plan(joint, *spaces);
  EXPECT_EQ(joint_first[0], space_of("joint_fluid"));
  EXPECT_EQ(joint_first[1], space_of("subacromial_bursa"));
  EXPECT_TRUE(std::is_permutation(joint_first.begin(), joint_first.end(), bursa_first.begin(),
                                  bursa_first.end()));
  for (const std::uint32_t space : bursa_first)
    EXPECT_EQ(spaces->spaces[space].law.kind, SpaceKind::cavity);
}

TEST_F(Overflow, LeavesWhatASpaceTakes) {
  const double most = spaces_->of(region_).max_volume();
  const auto places = with_overflow(*spaces_, {{"joint_fluid", 0.9 * most, true, tip_}});
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(places[0].volume, 0.9 * most);
}

TEST_F(Overflow, LeavesOutWhatTheBodyHasNoRoomForThoughTheSpaceHoldsIt) {
  const double most = spaces_->of(region_).max_volume();
  const auto places = with_overflow(
      *spaces_, {{"joint_fluid", 0.7 * most, true, tip_}, {"joint_fluid", 0.7 * most, true, tip_}});
  ASSERT_EQ(places.size(), 2U);
  EXPECT_NEAR(total(places), most, 1e-15);
}

TEST_F(Overflow, GivesWhatTearsTheSpaceToSoftTissueBesideIt) {
  const auto laws = make_joint_spaces(*joint_);
  ASSERT_TRUE(laws);
  const double most = laws->spaces[laws->of_region[region_]].law.rupture;
  ASSERT_TRUE(std::isfinite(most));
  const double room = spaces_->of(region_).max_volume();
  const auto torn = [&](double volume) {
    return with_overflow(*spaces_, {{"joint_fluid", volume, true, tip_}});
  };
  EXPECT_EQ(torn(most).size(), 1U);
  const auto places = torn(most + 0.4e-6);
  ASSERT_EQ(places.size(), 2U);
  EXPECT_NEAR(places[0].volume, room, 1e-15);
  EXPECT_FALSE(places[1].cavity);
  const auto beside = find_region(*joint_, places[1].region);
  ASSERT_TRUE(beside);
  const auto spread = [&](const Injected& place, double volume) {
    return std::min(volume, room_at(*joint_, *find_region(*joint_, place.region), place.tip));
  };
  EXPECT_NEAR(places[1].volume, spread(places[1], 0.4e-6), 1e-15);
  EXPECT_GT(places[1].volume, 1e-9);
  const Injected far = torn(most + 5e-6)[1];
  EXPECT_NEAR(far.volume, spread(far, 1e-6), 1e-15);  // the rest is not drawn
  EXPECT_FALSE(joint_->tissue_of(*beside).haptic.hard);
  const CompiledJoint with = with_injected(*joint_, places, Liquid{}, {}, *spaces_);
  EXPECT_TRUE(find_region(with, "injected").has_value());
}

TEST_F(Overflow, TearsAFilmThatIsThinnerThanTheLiquidIsThick) {
  const auto bursa = find_region(*joint_, "subacromial_bursa");
  ASSERT_TRUE(bursa);
  for (const Interface& f : joint_->mesh.interfaces) {
    const RegionId beside = f.front == *bursa ? f.back : f.front;
    if ((f.front != *bursa && f.back != *bursa) || joint_->regions[beside].name != "peribursal_fat")
      continue;
    const auto& p = joint_->mesh.vertices;
    const Vec3& a = p[f.vertices[0]];
    const Vec3 normal = (p[f.vertices[1]] - a).cross(p[f.vertices[2]] - a).normalized();
    const Vec3 out = f.back == *bursa ? normal : Vec3(-normal);
    const Vec3 middle = (a + p[f.vertices[1]] + p[f.vertices[2]]) / 3;
    if (out.dot(middle) < 0) continue;  // the side of the head, in the origin
    const auto near =
        with_overflow(*spaces_, {{"peribursal_fat", 0.5e-6, false, middle + 0.2e-3 * out}});
    ASSERT_EQ(near.size(), 1U);
    EXPECT_TRUE(near[0].cavity);
    EXPECT_EQ(near[0].region, "subacromial_bursa");
    EXPECT_EQ(near[0].volume, 0.5e-6);
    const auto far = with_overflow(*spaces_, {{"deltoid", 0.5e-6, false, middle + 5e-3 * out}});
    EXPECT_FALSE(far[0].cavity);
    return;
  }
  FAIL() << "the bursa lies under fat and deltoid";
}

TEST_F(Overflow, LeavesOutWhatAThinLayerHasNoRoomFor) {
  const auto skin = find_region(*joint_, "skin");
  ASSERT_TRUE(skin);
  const auto& mesh = joint_->mesh;
  const auto at = std::find(mesh.regions.begin(), mesh.regions.end(), *skin);
  ASSERT_NE(at, mesh.regions.end());
  Vec3 tip = Vec3::Zero();
  for (const std::uint32_t v : mesh.tetrahedra[static_cast<std::size_t>(at - mesh.regions.begin())])
    tip += mesh.vertices[v] / 4;
  const double room = room_at(*joint_, *skin, tip);
  EXPECT_GT(room, 1e-9);
  EXPECT_LT(room, 0.3e-6) << "2 mm of skin";
  const auto drawn = [&](double volume) {
    return with_overflow(*spaces_, {{"skin", volume, false, tip}})[0].volume;
  };
  EXPECT_EQ(drawn(2e-6), room);
  EXPECT_EQ(drawn(0.5 * room), 0.5 * room);
  const auto deltoid = find_region(*joint_, "deltoid");
  ASSERT_TRUE(deltoid);
  EXPECT_EQ(room_at(*joint_, *deltoid, tip), std::numeric_limits<double>::infinity())
      << "streaks between fibres spread by themselves";
}

TEST_F(Overflow, PartsALayerBesideWhichItIsToldToLieAtTheLayersNearestPoint) {
  const TetLocator locator(joint_->mesh);
  const auto region_at = [&](const Vec3& p) {
    const auto t = locator.find(p);
    return t < 0 ? kOutside : joint_->mesh.regions[static_cast<std::size_t>(t)];
  };
  const auto fat = find_region(*joint_, "peribursal_fat");
  ASSERT_TRUE(fat);
  const auto& p = joint_->mesh.vertices;
  int tried = 0;
  for (const Interface& f : joint_->mesh.interfaces) {
    const RegionId beside = f.front == *fat ? f.back : f.front;
    if ((f.front != *fat && f.back != *fat) || joint_->regions[beside].name != "deltoid") continue;
    const Vec3& a = p[f.vertices[0]];
    const Vec3 normal = (p[f.vertices[1]] - a).cross(p[f.vertices[2]] - a).normalized();
    const Vec3 beyond = (a + p[f.vertices[1]] + p[f.vertices[2]]) / 3 +
                        (f.back == *fat ? 0.7e-3 : -0.7e-3) * normal;
    if (region_at(beyond) != beside) continue;
    const Injected place =
        with_overflow(*spaces_, {{"peribursal_fat", 2e-9, false, beyond}}).front();
    if (place.cavity) continue;  // so near the bursa that it tears
    EXPECT_EQ(region_at(place.tip), *fat);
    EXPECT_LT((place.tip - beyond).norm(), 1.3e-3);
    if (++tried == 20) return;
  }
  FAIL() << "deltoid lies on fat";
}

TEST_F(Overflow, PartsTwoTissuesAtOnePlaceAsOnePocketOfTheOneThatGotMore) {
  const Vec3 away = tip_ + Vec3(0, 0, 5e-3);
  const auto places = with_overflow(*spaces_, {{"deltoid", 0.1e-6, false, tip_},
                                               {"infraspinatus", 0.3e-6, false, tip_},
                                               {"joint_fluid", 0.2e-6, true, tip_},
                                               {"teres_minor", 0.1e-6, false, away}});
  ASSERT_EQ(places.size(), 4U);
  EXPECT_EQ(places[0].volume, 0);
  EXPECT_NEAR(places[1].volume, 0.4e-6, 1e-15);
  EXPECT_EQ(places[2].volume, 0.2e-6);
  EXPECT_EQ(places[3].volume, 0.1e-6);
}

TEST_F(Overflow, IsThereOnlyOnce) {
  const auto once = with_overflow(*spaces_, {{"joint_fluid", 50e-6, true, tip_}});
  ASSERT_EQ(once.size(), 2U);
  const auto twice = with_overflow(*spaces_, once);
  ASSERT_EQ(once.size(), twice.size());
  for (std::size_t k = 0; k < once.size(); ++k) EXPECT_NEAR(once[k].volume, twice[k].volume, 1e-18);
}

}  // namespace
}  // namespace artus
