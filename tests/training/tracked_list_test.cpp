// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/tracked_list.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

std::string refusal(const std::string& text, const std::string& name,
                    const TrackedListOptions& options = {}) {
  const auto list = parse_tracked_list(text, name, options);
  return list ? "" : list.error().to_string();
}

constexpr const char* kHead =
    "time_s,entry_x_mm,entry_y_mm,entry_z_mm,tip_x_mm,tip_y_mm,tip_z_mm\n";

TEST(TrackedList, MillimetresAndMetresAreOneList) {
  const auto mm = parse_tracked_list(std::string(kHead) + "0,0,0,-10,0,0,20\n", "a.csv");
  const auto m = parse_tracked_list(
      R"({"time_s":0,"needle":{"entry_m":[0,0,-0.01],"tip_m":[0,0,0.02]}})", "a.jsonl");
  ASSERT_TRUE(mm) << mm.error().to_string();
  ASSERT_TRUE(m) << m.error().to_string();
  EXPECT_TRUE(mm->poses[0].X_JN->isApprox(*m->poses[0].X_JN, 1e-12));
  EXPECT_FALSE(mm->poses[0].X_JP);
}

TEST(TrackedList, QuaternionsAreNormalisedOrRefused) {
  const auto line = [](const char* q) {
    return std::string(R"({"time_s":1,"needle":{"position_mm":[1,2,3],"quaternion_wxyz":)") + q +
           "}}";
  };
  const auto list = parse_tracked_list(line("[0.7,0.7,0,0]"), "a.jsonl");
  ASSERT_TRUE(list);
  EXPECT_NEAR(list->poses[0].X_JN->linear().determinant(), 1, 1e-12);
  EXPECT_NEAR((list->poses[0].X_JN->linear() * Vec3::UnitZ() + Vec3::UnitY()).norm(), 0, 1e-12);
  EXPECT_NE(refusal(line("[0.2,0,0,0]"), "a.jsonl").find("a.jsonl:1"), std::string::npos);
  EXPECT_NE(refusal(line("[0.2,0,0,0]"), "a.jsonl").find("norm"), std::string::npos);
}

TEST(TrackedList, FallingTimesAreRefusedByLineOrSorted) {
  const std::string text =
      std::string(kHead) + "0,0,0,-10,0,0,1\n2,0,0,-10,0,0,3\n1,0,0,-10,0,0,2\n";
  EXPECT_NE(refusal(text, "x.csv").find("x.csv:4"), std::string::npos);
  const auto sorted = parse_tracked_list(text, "x.csv", {true});
  ASSERT_TRUE(sorted);
  EXPECT_EQ(sorted->poses[1].time, 1);
  ASSERT_FALSE(sorted->notices.empty());
}

TEST(TrackedList, GapsAndPosesOfOneTimeAreTold) {
  const auto list = parse_tracked_list(
      std::string(kHead) + "0,0,0,-10,0,0,1\n0,0,0,-10,0,0,1\n0.1,0,0,-10,0,0,2\n3,0,0,-10,0,0,2\n",
      "x.csv");
  ASSERT_TRUE(list);
  ASSERT_EQ(list->notices.size(), 2U);
  EXPECT_EQ(list->notices[0].substr(0, 7), "1 poses");
  EXPECT_EQ(list->notices[1].substr(0, 6), "1 gaps");
}

TEST(TrackedList, ANeedleOfTwoPointsDoesNotSpin) {
  std::string text = kHead;
  for (int i = 0; i < 200; ++i)
    text += std::to_string(0.1 * i) + ",0,0,0," + std::to_string(10 - 0.1 * i) + ",0.5,10\n";
  const auto list = parse_tracked_list(text, "x.csv");
  ASSERT_TRUE(list);
  for (std::size_t i = 1; i < list->poses.size(); ++i) {
    const Eigen::AngleAxisd turn(list->poses[i - 1].X_JN->linear().transpose() *
                                 list->poses[i].X_JN->linear());
    EXPECT_LT(turn.angle(), 0.02);
  }
}

TEST(TrackedList, WhatIsWrongIsNamedWithItsLine) {
  const std::string good = "0,0,0,-10,0,0,1\n";
  EXPECT_NE(refusal(kHead + good + "1,0,0,-10,0,0,nan\n", "x.csv").find("x.csv:3"),
            std::string::npos);
  EXPECT_NE(refusal(kHead + good + "1,0,0,-10,0,0\n", "x.csv").find("6 cells"), std::string::npos);
  EXPECT_NE(refusal(std::string(kHead) + ",0,0,-10,0,0,1\n", "x.csv").find("time_s"),
            std::string::npos);
  EXPECT_NE(refusal(std::string(kHead) + "0,0,0,-10,0,,1\n", "x.csv").find("companion"),
            std::string::npos);
  EXPECT_NE(refusal("time_s,colour\n0,1\n", "x.csv").find("colour"), std::string::npos);
  EXPECT_NE(refusal(kHead, "x.csv").find("no pose"), std::string::npos);
  EXPECT_NE(refusal("{}", "x.txt").find(".jsonl or .csv"), std::string::npos);
  EXPECT_NE(refusal("[1]", "x.jsonl").find("x.jsonl:1"), std::string::npos);
  EXPECT_NE(
      refusal(std::string(kHead) + "0,0,0,-10,0,0,1\n1e9,0,0,-10,0,0,1\n", "x.csv").find("seconds"),
      std::string::npos);
}

}  // namespace
}  // namespace artus
