// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/judgement.h"

#include <utility>

#include <gtest/gtest.h>

#include "artus/detail/training/metrics/limits.h"

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

TEST(Judgement, HandsThatFeelNothingAreNotJudgedByForce) {
  std::vector<Mark> all = marks();
  all.push_back(*parse_mark("bone_peak_n", "<= 3"));
  all.push_back(*parse_mark("pressure_peak_kpa", "<= 50"));
  auto metrics = measured(1, 0.9);
  metrics.push_back({"bone_peak_n", "needle", "N", 9, "", {}});
  EXPECT_FALSE(judge(metrics, all, {}, false).passed);
  const Judgement unfelt = judge(metrics, all, {}, false, false);
  EXPECT_TRUE(unfelt.passed);
  EXPECT_EQ(unfelt.marks.size(), 2U);
  ASSERT_EQ(unfelt.unjudged.size(), 2U);
  EXPECT_EQ(unfelt.unjudged[0].metric, "bone_peak_n");
  EXPECT_FALSE(judge(metrics, {{all[2]}}, {}, false, false).passed) << "nothing was judged";
  EXPECT_TRUE(needs_force("force_peak_n:skin"));
  EXPECT_FALSE(needs_force("bone_contacts"));
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
  EXPECT_EQ(judged.score, kFailedScore * 3 / 4);  // distance weighs 3, sight 1
}

TEST(Judgement, TheScoreIsTheWeightedMeanOfItsParts) {
  const std::vector<ScoreWeight> weights{{"distance_mm", 3}};
  const Judgement judged = judge(measured(3, 1), marks(), weights, false);
  EXPECT_DOUBLE_EQ(judged.marks[0].part, 0.5);
  EXPECT_DOUBLE_EQ(judged.score, kFailedScore * (3 * 0.5 + 1) / 4);
}

TEST(Judgement, NoFailureScoresAsMuchAsAPassAndDangerCostsMost) {
  const std::vector<Mark> all{*parse_mark("distance_mm", "<= 2"), *parse_mark("drift_mm_s", "<= 1"),
                              *parse_mark("bone_contacts", "== 0"),
                              *parse_mark("avoid_fatal", "== 0"), *parse_mark("withdrawn", "== 1")};
  const auto score = [&](double distance, double drift, double bone, double fatal, double out) {
    const std::vector<Metric> m{{"distance_mm", "needle", "mm", distance, "", {}},
                                {"drift_mm_s", "probe", "mm/s", drift, "", {}},
                                {"bone_contacts", "needle", "count", bone, "", {}},
                                {"avoid_fatal", "needle", "count", fatal, "", {}},
                                {"withdrawn", "needle", "-", out, "", {}}};
    return judge(m, all, {}, false).score;
  };
  const double pass = score(2, 1, 0, 0, 1);
  const double style = score(2, 1.5, 0, 0, 1);
  const double off = score(3, 1, 0, 0, 1);
  const double bone = score(2, 1, 1, 0, 1);
  const double left = score(2, 1, 0, 0, 0);
  const double fatal = score(2, 1, 0, 1, 1);
  EXPECT_EQ(pass, 100);
  EXPECT_LT(style, kFailedScore);
  EXPECT_LT(off, style);
  EXPECT_LT(bone, off);
  EXPECT_LE(left, bone);
  EXPECT_LT(fatal, left);
  EXPECT_LT(fatal, kFatalScore);
}

TEST(Judgement, WhatIsFatalFailsMarkedOrNot) {
  std::vector<Metric> m = measured(1, 1);
  m.push_back({"avoid_fatal", "needle", "count", 1.0, "", {}});
  const Judgement judged = judge(m, marks(), {}, false);
  EXPECT_FALSE(judged.passed);
  EXPECT_LE(judged.score, kFatalScore);
}

TEST(Judgement, WhatSafetyForbidsFailsMarkedOrNot) {
  for (const auto& [metric, value] :
       {std::pair{"pressure_peak_kpa", 101.0}, std::pair{"avoid_entries", 1.0},
        std::pair{"withdrawn", 0.0}, std::pair{"avoid_fatal", 1.0}}) {
    std::vector<Metric> m = measured(1, 1);
    m.push_back({metric, "needle", "-", value, "", {}});
    const Judgement judged = judge(m, marks(), {}, false);
    EXPECT_FALSE(judged.passed) << metric;
    EXPECT_LE(judged.score, kDangerScore) << metric;
    ASSERT_EQ(judged.marks.size(), 3U) << metric;
    EXPECT_EQ(judged.marks[2].mark.metric, metric) << "told among the marks";
  }
}

TEST(Judgement, ATaskSetsItsOwnLimitOfPressure) {
  std::vector<Mark> all = marks();
  all.push_back(*parse_mark("pressure_peak_kpa", "<= 250"));
  auto metrics = measured(1, 1);
  metrics.push_back({"pressure_peak_kpa", "syringe", "kPa", 200.0, "", {}});
  EXPECT_EQ(judge(metrics, all, {}, false).score, 100);
  EXPECT_TRUE(judge(metrics, marks(), {}, false, false).passed) << "nobody felt it";
}

TEST(Judgement, AHundredStandsBesideNothingThatHarms) {
  for (const auto& [metric, value] :
       {std::pair{"bone_contacts", 1.0}, std::pair{"unseen_mm", 1.5}, std::pair{"given_ml", 1.0}}) {
    std::vector<Metric> m = measured(1, 1);
    m.push_back({metric, "needle", "-", value, "", {}});
    const Judgement judged = judge(m, marks(), {}, false);
    EXPECT_TRUE(judged.passed) << metric;
    EXPECT_EQ(judged.score, kFlawedScore) << metric;
  }
  EXPECT_GT(kFlawedScore, kFailedScore);
  auto allowed = marks();
  allowed.push_back(*parse_mark("bone_contacts", "<= 1"));
  auto m = measured(1, 1);
  m.push_back({"bone_contacts", "needle", "count", 1.0, "", {}});
  EXPECT_EQ(judge(m, allowed, {}, false).score, 100);
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
