// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/liquid_at_tip.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

TEST(LiquidAtTip, IsThatOfThePlaceInWhoseBallTheTipLies) {
  HapticSnapshot now;
  now.inserted = 1;
  now.n_sites = 2;
  now.sites[0] = {{0, 0, 0.02}, 1e-6, 5, 1};    // a ball of 6.2 mm
  now.sites[1] = {{0, 0, 0.03}, 0.5e-8, 7, 0};  // less than anybody speaks of
  now.X_JN.position[2] = 0.02;
  EXPECT_EQ(liquid_at_tip(now), RegionId{5});
  now.X_JN.position[0] = 6.1e-3;
  EXPECT_EQ(liquid_at_tip(now), RegionId{5});
  now.X_JN.position[0] = 6.3e-3;
  EXPECT_FALSE(liquid_at_tip(now));
  now.X_JN.position[0] = 0;
  now.X_JN.position[2] = 0.03;
  EXPECT_FALSE(liquid_at_tip(now));
  now.sites[1].volume = 2e-8;
  now.X_JN.position[1] = 0.9e-3;
  EXPECT_EQ(liquid_at_tip(now), RegionId{7});
  now.inserted = 0;
  EXPECT_FALSE(liquid_at_tip(now));
}

}  // namespace
}  // namespace artus
