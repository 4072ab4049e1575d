// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/skin_puncture.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

NeedlePlace at(const Vec3& tip) {
  return {tip, Eigen::Quaterniond::Identity(), tip.z()};
}

TEST(SkinPuncture, IsWholeUntilANeedleLeavesAHoleAndClosesWithTheWayAboveIt) {
  SkinPuncture skin(0.5e-3);
  EXPECT_EQ(skin.wholeness(), 1);
  skin.leave(Vec3::Zero(), at(Vec3(0, 0, -1e-7)));
  EXPECT_NEAR(skin.wholeness(), 2e-4, 1e-9);
  skin.wait(at(Vec3(0, 0, -0.25e-3)));
  EXPECT_NEAR(skin.wholeness(), 0.5, 1e-9);
  skin.wait(at(Vec3(0, 0, -0.1e-3)));
  EXPECT_NEAR(skin.wholeness(), 0.5, 1e-9) << "it does not open again";
  skin.wait(at(Vec3(0, 0, -2e-3)));
  EXPECT_EQ(skin.wholeness(), 1);
}

TEST(SkinPuncture, GoesWithATipForTwoMillimetresAside) {
  SkinPuncture skin(0.5e-3);
  skin.leave(Vec3::Zero(), at(Vec3::Zero()));
  skin.wait(at(Vec3(2e-3, 0, 0)));
  EXPECT_NEAR(skin.wholeness(), 0, 1e-9);
  skin.wait(at(Vec3(2.25e-3, 0, 0)));
  EXPECT_NEAR(skin.wholeness(), 0.5, 1e-9);
}

TEST(SkinPuncture, PlacesACrossingBetweenTwoTicks) {
  SkinPuncture skin(0.5e-3);
  const NeedlePlace now = at(Vec3(1e-3, 0, 1e-3));
  EXPECT_EQ(skin.between(now, 0).tip, now.tip) << "nothing is known of the tick before";
  skin.wait(at(Vec3(0, 0, -1e-3)));
  EXPECT_LT((skin.between(now, 0).tip - Vec3(0.5e-3, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(skin.last_dimple(now.depth), 0);
}

}  // namespace
}  // namespace artus
