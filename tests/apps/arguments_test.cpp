// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/arguments.h"

#include <gtest/gtest.h>

#include "artus/detail/apps/options/companion_program.h"

namespace artus {
namespace {

TEST(Arguments, APointIsReadInMillimetres) {
  const auto p = parse_point_mm("1,-2.5,3e1", "--tip");
  ASSERT_TRUE(p.has_value());
  EXPECT_LT((*p - Vec3(0.001, -0.0025, 0.03)).norm(), 1e-15);
}

TEST(Arguments, AnythingButThreeFiniteNumbersIsRefusedWithTheFlag) {
  for (const char* text : {"", "1,2", "1,2,3,4", "1,2,x", "1,2,nan", "inf,0,0", "1,,3", "1 2 3"}) {
    const auto p = parse_point_mm(text, "--tip");
    ASSERT_FALSE(p.has_value()) << text;
    EXPECT_EQ(p.error().where, "--tip");
    EXPECT_EQ(p.error().code, ErrorCode::malformed);
  }
}

TEST(Arguments, APlaceThatNoJointHasIsRefusedInTheFlagsUnit) {
  const auto p = parse_point_mm("1e9,0,0", "--entry");
  ASSERT_FALSE(p.has_value());
  EXPECT_EQ(p.error().code, ErrorCode::malformed);
  EXPECT_NE(p.error().message.find("points are in mm"), std::string::npos);
  EXPECT_TRUE(parse_point_mm("-235,-60,1330", "--entry").has_value()) << "as atlases have them";
}

TEST(Arguments, AProbeLooksAlongItsDirectionWithItsLateralAxis) {
  const auto pose = parse_probe_pose("10,0,0/-1,0,0/0,0,1", "--probe");
  ASSERT_TRUE(pose.has_value());
  EXPECT_LT((pose->translation() - Vec3(0.01, 0, 0)).norm(), 1e-15);
  EXPECT_LT((pose->linear().col(2) - Vec3(-1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((pose->linear().col(0) - Vec3(0, 0, 1)).norm(), 1e-15);
}

TEST(Arguments, AProbeWithParallelAxesIsRefused) {
  EXPECT_FALSE(parse_probe_pose("0,0,0/0,0,1/0,0,-2", "--probe").has_value());
  EXPECT_FALSE(parse_probe_pose("0,0,0/0,0,0", "--probe").has_value());
  EXPECT_FALSE(parse_probe_pose("0,0,0", "--probe").has_value());
}

TEST(CompanionProgram, OneThatIsNotThereIsNamedWithWhatToDo) {
  const auto program = find_companion("artus-nothing", ", build it");
  ASSERT_FALSE(program.has_value());
  EXPECT_EQ(program.error().code, ErrorCode::not_found);
  EXPECT_EQ(program.error().message, "artus-nothing, build it");
}

TEST(Arguments, ANeedlePointsFromEntryToTip) {
  const auto pose = parse_needle_pose("0,0,0/0,0,-20", "--needle");
  ASSERT_TRUE(pose.has_value());
  EXPECT_LT((pose->translation() - Vec3(0, 0, -0.02)).norm(), 1e-15);
  EXPECT_LT((pose->linear().col(2) - Vec3(0, 0, -1)).norm(), 1e-15);
  EXPECT_FALSE(parse_needle_pose("1,1,1/1,1,1", "--needle").has_value());
}

TEST(Arguments, LengthUnitsAreInMetres) {
  EXPECT_DOUBLE_EQ(length_unit("mm"), 1e-3);
  EXPECT_DOUBLE_EQ(length_unit("cm"), 1e-2);
  EXPECT_DOUBLE_EQ(length_unit("m"), 1);
}

}  // namespace
}  // namespace artus
