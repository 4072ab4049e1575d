// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/scanning_operator.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

/// Hands without errors on a straight way down, which see what is shown to them.
class Giving : public testing::Test {
 protected:
  Giving() : hands_(skill(), plan(), 7) {}
  static OperatorSkill skill() {
    OperatorSkill skill;
    skill.aim_sd = skill.entry_sd = skill.view_sd = skill.view_turn_sd = skill.judge_sd = 0;
    skill.see = skill.look = skill.feel = 1;
    skill.drift = 0;
    return skill;
  }
  static ScanPlan plan() {
    ScanPlan plan;
    plan.target = Vec3(0, 0, 20e-3);
    return plan;
  }
  /// Glances until `until` s, the needle where the hand wants it.
  void go(double until, bool given, bool astray, bool tents = false, bool resists = false) {
    for (; time_ < until; time_ += 0.05) {
      const Pose X_JN = hands_.intention(time_).X_JN;
      ScanGlance glance;
      glance.visible = true;
      glance.depth = std::max(0.0, X_JN.translation().z());
      glance.given = given;
      glance.astray = astray;
      glance.tents = tents;
      glance.resists = resists;
      hands_.look(time_, X_JN, glance);
    }
  }
  [[nodiscard]] double depth() const { return hands_.intention(time_).X_JN.translation().z(); }

  ScanningOperator hands_;
  double time_ = 0;
};

TEST_F(Giving, TheNeedleRestsUntilAllIsGiven) {
  go(20, false, false);
  EXPECT_TRUE(hands_.holds());
  const double held = depth();
  go(40, false, false);
  EXPECT_TRUE(hands_.holds());
  EXPECT_DOUBLE_EQ(depth(), held);
  go(60, true, false);
  EXPECT_TRUE(hands_.done());
}

TEST_F(Giving, WhenTheLineDoesNotSplitItMovesTowardTheTargetAFewTimes) {
  go(20, false, false);
  ASSERT_TRUE(hands_.holds());
  const double before = std::abs(depth() - 20e-3);
  go(22, false, true);
  EXPECT_TRUE(hands_.holds());
  EXPECT_LT(std::abs(depth() - 20e-3), before);
  go(60, false, true);
  const double settled = depth();
  go(90, false, true);
  EXPECT_DOUBLE_EQ(depth(), settled);
}

TEST_F(Giving, AWallThatTentsIsPushedThroughButNotForEver) {
  go(6, false, false, true);
  EXPECT_FALSE(hands_.holds());
  EXPECT_GT(depth(), 20e-3);
  go(30, false, false, true);
  EXPECT_TRUE(hands_.holds());
  EXPECT_NEAR(depth(), 25e-3, 1e-3);
}

TEST_F(Giving, WhatGivesIsNoReasonToGoOn) {
  go(6, false, false, true);
  ASSERT_FALSE(hands_.holds());
  const double there = depth();
  ASSERT_GT(there, 20e-3);
  go(7, false, false);
  EXPECT_TRUE(hands_.holds());
  EXPECT_NEAR(depth(), there, 1e-3);
}

TEST_F(Giving, AThumbThatMeetsResistanceLetsGoWhileTheNeedleIsMoved) {
  go(20, false, false);
  ASSERT_TRUE(hands_.holds());
  EXPECT_FALSE(hands_.eases(time_));
  const double before = depth();
  go(20.1, false, false, false, true);
  EXPECT_TRUE(hands_.eases(time_));
  EXPECT_TRUE(hands_.holds());
  EXPECT_GT(std::abs(depth() - before), 0.5e-3);
  go(21, false, false);
  EXPECT_FALSE(hands_.eases(time_));
}

TEST_F(Giving, AThumbThatMeetsResistanceTriesElsewhereAFewTimes) {
  go(20, false, false, false, true);
  const double settled = depth();
  EXPECT_FALSE(hands_.eases(time_));
  go(60, false, false, false, true);
  EXPECT_DOUBLE_EQ(depth(), settled);
}

TEST_F(Giving, TimeEndsIt) {
  go(181, false, false);
  EXPECT_FALSE(hands_.holds());
}

}  // namespace
}  // namespace artus
