// SPDX-License-Identifier: AGPL-3.0-or-later
// The marks of every bundled scenario for the needle, and attempts whose verdict is known before
// they are made, by the rules of docs/training.md.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/training/feedback.h"
#include "artus/detail/training/metrics/closed_body.h"
#include "artus/detail/training/player.h"
#include "artus/detail/training/scenario.h"
#include "tests/training/scripted_hands.h"

namespace artus {
namespace {

using test::ScriptedHands;

constexpr double kDeep = 23;  // mm, in the bursa, over the tendon that must never be entered

/// `angle`: degrees to the face, of a straight way to the depth that is meant.
Goals bursa_over_tendon(double angle) {
  const auto scene = test::make_layered_scene();
  Goals goals = test::bursa_goals(scene->joint());
  const auto tendon = find_region(scene->joint(), "tendon");
  goals.entry = Vec3(-1e-3 * kDeep / std::tan(angle * kDegree), 0, 0);
  goals.avoid.push_back({"tendon", make_region_body(scene->joint(), *tendon), 0, true});
  return goals;
}

enum class Way {
  perfect,
  pauses,
  flips,
  blind,
  off,
  wrong_side,
  leaves_early,
  too_fast,
  fatal,
  left_in,
  late
};

/// What is written down of a way before it is gone.
struct Known {
  Way way;
  const char* name;
  std::vector<std::string> breaks;  ///< marks of which one is missed; those of all are not named
  bool always;                      ///< fails whatever the marks
  const char* first;                ///< fault; empty: none
  double most;                      ///< points of who fails
};

std::vector<Known> known_ways() {
  return {{Way::perfect, "perfect", {}, false, "", 100},
          {Way::pauses, "pauses on the way out", {}, false, "", 100},
          {Way::flips, "flips", {}, false, "", 100},
          {Way::blind, "blind", {"unseen_advances", "plane_offset_p90_mm"}, false, "unseen", 60},
          {Way::off, "off", {"distance_mm", "in_target"}, false, "off_target", 60},
          {Way::wrong_side, "wrong side", {"entry_offset_mm"}, false, "entry", 60},
          {Way::leaves_early,
           "leaves early",
           {"distance_mm", "given_ml", "unseen_advances"},
           false,
           "off_target",
           60},
          {Way::too_fast, "too fast", {"flow_peak_ml_s"}, false, "fast", 60},
          {Way::fatal, "through what is fatal", {}, true, "fatal:tendon", 20},
          {Way::left_in, "left in", {}, true, "left_in", 40},
          {Way::late, "too late", {}, true, "late", 60}};
}

/// One way through one task.
class Walk {
 public:
  Walk(const Scenario& scenario, double angle)
      : scenario_(scenario), hands_(angle, bursa_over_tendon(angle)), angle_(angle) {}

  AttemptMeasures go(Way way) {
    hands_.feels = true;
    hands_.aside = way == Way::blind ? 2.5 : 0;
    if (way == Way::wrong_side) side_ = 13;
    const bool shallow = way == Way::off || way == Way::leaves_early;
    bring(way == Way::off ? kDeep - 8 : way == Way::leaves_early ? 6 : kDeep, way == Way::flips);
    if (way == Way::fatal) bring(26, false);
    if (way == Way::fatal) bring(kDeep, false);
    hands_.go(1, shallow ? depth_ : kDeep);
    if (way != Way::leaves_early) give(way == Way::too_fast ? 0.9 : 0);
    if (way == Way::late) hands_.sweep(scenario_.time_limit + 2);
    if (way == Way::left_in) return hands_.measure();
    if (way == Way::pauses) {
      hands_.go(1, 8);
      hands_.go(3, 8);
    }
    hands_.go(2, -5);
    return hands_.measure();
  }

 private:
  void bring(double depth, bool flips) {
    hands_.along = side_ - (kDeep - 15) / std::tan(angle_ * kDegree);
    for (int i = 1; i <= 3; ++i) {
      hands_.go(1.2, depth_ + (depth - depth_) * i / 3);
      if (flips) hands_.flip(2);
    }
    depth_ = depth;
  }
  /// Aspirates and gives what the task asks for; `ml_s` 0: as fast as it asks.
  void give(double ml_s) {
    const double volume = scenario_.syringe.volume / kCubicCentimetre;
    if (volume <= 0) return;
    hands_.inject(3, -0.01, -10);
    const double rate = ml_s > 0 ? ml_s : scenario_.syringe.rate / kCubicCentimetre;
    hands_.inject(volume / rate, rate, 40);
  }

  const Scenario& scenario_;
  ScriptedHands hands_;
  double angle_;
  double side_ = 0;    // mm along the face
  double depth_ = -5;  // mm
};

bool breaks(const Known& known, const Scenario& scenario) {
  return known.always ||
         std::any_of(scenario.pass.begin(), scenario.pass.end(), [&](const Mark& mark) {
           return std::find(known.breaks.begin(), known.breaks.end(), mark.metric) !=
                  known.breaks.end();
         });
}

TEST(ScenarioVerdicts, TheMarksOfEveryBundledTaskJudgeAsWrittenDown) {
  int attempts = 0;
  double angle = 30;
  for (const std::string_view text : bundled_scenario_texts()) {
    const auto scenario = parse_scenario(text, "bundled");
    ASSERT_TRUE(scenario.has_value());
    if (!scenario->find.empty()) continue;
    angle = angle >= 38 ? 30 : angle + 0.7;
    double passed = 0;
    for (const Known& known : known_ways()) {
      if (known.way == Way::too_fast && scenario->syringe.volume <= 0) continue;
      if (known.way == Way::late && scenario->level > 2) continue;  // minutes each
      AttemptMeasures m = Walk(*scenario, angle).go(known.way);
      add_asked(*scenario, {scenario->steps.begin(), scenario->steps.end()}, m.metrics);
      const Judgement judged = judge(m.metrics, scenario->pass, scenario->score, false);
      const Feedback told = make_feedback(m, judged, {scenario->level, {}});
      const std::string what = scenario->name + ", " + known.name + ": " + told.verdict;
      const bool fails = breaks(known, *scenario);
      EXPECT_EQ(judged.passed, !fails) << what;
      const std::string first = told.faults.empty() ? "" : told.faults.front().kind;
      // Liquid goes where the tip is: who gives it there is told of the liquid, if it is not
      // little.
      const bool astray = known.way == Way::off && scenario->syringe.volume > 0.5e-6;
      const bool little = known.way == Way::off && scenario->syringe.volume > 0 && !astray;
      if (!little || first != "misplaced") {
        EXPECT_EQ(first, astray ? "misplaced" : known.first) << what;
      }
      if (known.way == Way::perfect) passed = judged.score;
      EXPECT_EQ(passed, 100) << what;
      if (fails) {
        EXPECT_LE(judged.score, known.most) << what;
      }
      ++attempts;
    }
  }
  EXPECT_GE(attempts, 200);
}

TEST(ScenarioVerdicts, WhoDoesNotAskDoesNotPassWhereTheTaskSaysSo) {
  const auto scenario = find_scenario("ssn-notch-2");
  ASSERT_TRUE(scenario);
  AttemptMeasures m = Walk(*scenario, 33).go(Way::perfect);
  add_asked(*scenario, {"ask:side", "ask:allergy"}, m.metrics);
  const Judgement judged = judge(m.metrics, scenario->pass, scenario->score, false);
  EXPECT_FALSE(judged.passed);
  EXPECT_LE(judged.score, kDangerScore);
  EXPECT_DOUBLE_EQ(find_metric(m.metrics, "asked")->value.value_or(0), 0.4);
  const Feedback told = make_feedback(m, judged);
  ASSERT_FALSE(told.faults.empty());
  EXPECT_EQ(told.faults.front().kind, "unasked") << "told first of all";
  EXPECT_EQ(told.faults.front().cause, "40 of 100 of the task's questions were asked");
  EXPECT_TRUE(told.good.empty()) << "danger is not praised";
  std::vector<Metric> none;
  add_asked(*find_scenario("gel-align"), {}, none);
  EXPECT_TRUE(none.empty()) << "a block is asked nothing";
}

}  // namespace
}  // namespace artus
