// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/pneumatic_params.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>

namespace artus {
namespace {

using testing::HasSubstr;

TEST(PneumaticParams, BundledFileHoldsTheDefaults) {
  const auto read = read_bundled_pneumatic_params();
  ASSERT_TRUE(read) << read.error().to_string();
  const PneumaticParams built_in;
  EXPECT_EQ(read->cylinder.area_P, built_in.cylinder.area_P);
  EXPECT_EQ(read->cylinder.area_N, built_in.cylinder.area_N);
  EXPECT_EQ(read->cylinder.travel, built_in.cylinder.travel);
  EXPECT_EQ(read->valve.sonic_conductance, built_in.valve.sonic_conductance);
  EXPECT_EQ(read->valve.supply, built_in.valve.supply);
  EXPECT_EQ(read->sensors.position.step, built_in.sensors.position.step);
  EXPECT_EQ(read->sensors.force.high, built_in.sensors.force.high);
}

TEST(PneumaticParams, ValuesReplaceDefaults) {
  const auto read = parse_pneumatic_params(
      "format = 1\n[cylinder]\nstroke_m = 0.1\n[sensors.pressure]\nnoise = 7\n", "t");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->cylinder.stroke, 0.1);
  EXPECT_EQ(read->sensors.pressure.noise, 7);
  EXPECT_EQ(read->cylinder.moving_mass, 0.37);
}

TEST(PneumaticParams, EveryProblemIsNamed) {
  const auto read = parse_pneumatic_params(
      "format = 1\n[cylinder]\nstroke_m = -1\nweight = 3\n[valve]\nsupply_pa = 5e4\n", "mock.toml");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::invalid);
  EXPECT_EQ(read.error().where, "mock.toml");
  EXPECT_THAT(read.error().message, HasSubstr("stroke_m"));
  EXPECT_THAT(read.error().message, HasSubstr("weight"));
  EXPECT_THAT(read.error().message, HasSubstr("exhaust_pa"));
}

TEST(PneumaticParams, TravelMustLeaveBothChambersAVolume) {
  const auto read = parse_pneumatic_params("format = 1\n[cylinder]\ntravel_m = 0.025\n", "t");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("travel_m"));
}

TEST(PneumaticParams, MissingFileAndBrokenSyntaxAreToldApart) {
  EXPECT_EQ(read_pneumatic_params("/no/such/file.toml").error().code, ErrorCode::not_found);
  EXPECT_EQ(parse_pneumatic_params("format = ", "t").error().code, ErrorCode::malformed);
}

}  // namespace
}  // namespace artus
