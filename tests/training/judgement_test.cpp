// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/judgement.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

std::vector<Metric> measured(double distance, std::optional<double> seen) {
  return {{"distance_mm", "needle", "mm", distance, "", {}},
          {"tip_seen", "both", "-", seen, "", {}}};
}

std::vector<Mark> marks() {
  return {*parse_mark("distance_mm", "<= 2"), *parse_mark("tip_seen", ">= 0.8")};
}

TEST(Judgement, AllMarksMustHold) {
  EXPECT_TRUE(judge(measured(2, 0.8), marks(), {}, false).passed);
  EXPECT_FALSE(judge(measured(2.001, 0.8), marks(), {}, false).passed);
  EXPECT_FALSE(judge(measured(2, 0.79), marks(), {}, false).passed);
}

TEST(Judgement, NothingPassesWithAidsOn) {
  const Judgement judged = judge(measured(0, 1), marks(), {}, true);
  EXPECT_FALSE(judged.passed);
  EXPECT_EQ(judged.score, 100);
}

TEST(Judgement, AMarkOnWhatIsNotKnownDoesNotHold) {
  const Judgement judged = judge(measured(0, std::nullopt), marks(), {}, false);
  EXPECT_FALSE(judged.passed);
  EXPECT_FALSE(judged.marks[1].held);
  EXPECT_EQ(judged.score, 50);
}

TEST(Judgement, TheScoreIsTheWeightedMeanOfItsParts) {
  const std::vector<ScoreWeight> weights{{"distance_mm", 3}};
  const Judgement judged = judge(measured(3, 1), marks(), weights, false);
  EXPECT_DOUBLE_EQ(judged.marks[0].part, 0.5);
  EXPECT_DOUBLE_EQ(judged.score, 100 * (3 * 0.5 + 1) / 4);
}

TEST(Judgement, WithoutMarksNothingPasses) {
  EXPECT_FALSE(judge(measured(0, 1), {}, {}, false).passed);
}

TEST(Judgement, MarksAreRelationsAndNumbers) {
  for (const char* text : {"<= 2", "<2", "== 0", ">=0.8", "> -1e3"})
    EXPECT_TRUE(parse_mark("m", text)) << text;
  for (const char* text : {"", "2", "<=", "<= two", "=< 2", "<= 2 mm", "<= nan", ">= inf", "!= 3"})
    EXPECT_FALSE(parse_mark("m", text)) << text;
}

TEST(Judgement, AHundredPointsMeanThatEveryMarkHeld) {
  EXPECT_EQ(whole_points(100), 100);
  EXPECT_EQ(whole_points(100 - 1e-12), 100);
  EXPECT_EQ(whole_points(99.97), 99);
  EXPECT_EQ(whole_points(0), 0);
}

}  // namespace
}  // namespace artus
