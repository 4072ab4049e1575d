// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/syringe_choice.h"

#include <limits>

#include <gtest/gtest.h>

namespace artus {
namespace {

TEST(SyringeChoice, IsRefusedByWhatIsWrong) {
  SyringeChoice choice;
  EXPECT_TRUE(make_plunger_params(choice, 0.05));
  choice.liquid = "coffee";
  EXPECT_EQ(make_plunger_params(choice, 0.05).error().code, ErrorCode::not_found);
  choice = {};
  choice.gauge = 24;
  EXPECT_EQ(make_plunger_params(choice, 0.05).error().code, ErrorCode::not_found);
  choice = {};
  choice.filled = 5e-6;
  choice.barrel = 1e-6;
  EXPECT_EQ(make_plunger_params(choice, 0.05).error().code, ErrorCode::invalid);
  choice = {};
  choice.air = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(make_plunger_params(choice, 0.05).error().code, ErrorCode::invalid);
}

TEST(SyringeChoice, OfAFullBarrelCanStillBeDrawn) {
  const auto params = make_plunger_params({}, 0.05);
  ASSERT_TRUE(params);
  EXPECT_DOUBLE_EQ(params->syringe.filled, 5e-6);
  EXPECT_DOUBLE_EQ(params->syringe.volume, 6e-6);
}

}  // namespace
}  // namespace artus
