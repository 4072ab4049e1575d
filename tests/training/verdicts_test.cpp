// SPDX-License-Identifier: AGPL-3.0-or-later
// A hundred attempts whose verdict is known before they are made, by the rules of docs/training.md:
// eleven ways to do a task, each in ten forms (angle, speed, rests).
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "artus/detail/training/feedback.h"
#include "artus/detail/training/metrics/closed_body.h"
#include "tests/training/scripted_hands.h"

namespace artus {
namespace {

using test::ScriptedHands;

constexpr double kTarget = 18;  // mm deep

/// A point in the muscle, and below it what must never be entered.
Goals goals_of() {
  const auto scene = test::make_layered_scene();
  Goals goals;
  goals.target = Target{"the target", Vec3(0, 0, 1e-3 * kTarget), nullptr};
  const auto tendon = find_region(scene->joint(), "tendon");
  goals.avoid.push_back({"tendon", make_region_body(scene->joint(), *tendon), 0, true});
  return goals;
}

/// Who gives nothing is not asked how fast.
std::vector<Mark> marks_of(const AttemptMeasures& m) {
  std::vector<Mark> marks{
      *parse_mark("distance_mm", "<= 2"), *parse_mark("unseen_advances", "<= 1"),
      *parse_mark("passes", "<= 2"),      *parse_mark("drift_mm_s", "<= 2"),
      *parse_mark("avoid_fatal", "== 0"), *parse_mark("withdrawn", "== 1"),
      *parse_mark("done_s", "<= 100")};
  if (m.syringe.used) marks.push_back(*parse_mark("flow_peak_ml_s", "<= 0.3"));
  return marks;
}

/// One form of an attempt: 0 to 9.
struct Form {
  int number = 0;
  [[nodiscard]] double angle() const { return 30 + 1.2 * number; }
  [[nodiscard]] double way() const { return 3 + 0.4 * number; }  ///< s
  [[nodiscard]] double rest() const { return 1 + 2.5 * number; }
};

/// Aspirates and gives 1 ml.
void give(ScriptedHands& hands, double ml_s = 0.2, double kpa = 40) {
  hands.inject(3, -0.01, -10);
  hands.inject(1 / ml_s, ml_s, kpa);
}

struct Kind {
  const char* name;
  std::function<void(ScriptedHands&, const Form&)> act;
  bool passed;
  const char* first;   ///< fault; empty: none of harm or purpose
  double least, most;  ///< score
};

/// The needle's line meets the target when it meets the point 15 mm deep this far along the face.
double along(const Form& form) {
  return -(kTarget - 15) / std::tan(form.angle() * kDegree);
}

/// Brings the needle to `depth` mm on the line to the target.
void bring(ScriptedHands& hands, const Form& form, double depth = kTarget) {
  hands.along = along(form);
  hands.go(form.way(), depth);
}

std::vector<Kind> kinds_without_harm() {
  return {{"perfect",
           [](auto& h, const Form& f) {
             bring(h, f);
             h.go(f.rest(), kTarget);
             give(h);
             h.go(2, -5);
           },
           true, "", 100, 100},
          {"pauses on the way out",
           [](auto& h, const Form& f) {
             bring(h, f);
             h.go(f.rest() + 1, kTarget);
             h.go(1, 8 - 0.5 * f.number);
             h.go(0.5 + 0.4 * f.number, 8 - 0.5 * f.number);
             h.go(f.way(), -5);
           },
           true, "", 100, 100},
          {"flips",
           [](auto& h, const Form& f) {
             for (int i = 1; i <= 3; ++i) {
               h.along = along(f);
               h.go(f.way() / 3, -5 + (kTarget + 5) * i / 3);
               h.flip(1 + f.number % 5);
             }
             give(h);
             h.go(2, -5);
           },
           true, "", 100, 100},
          {"blind",
           [](auto& h, const Form& f) {
             h.aside = 1.9;
             bring(h, f);
             give(h);
             h.go(2, -5);
           },
           false, "unseen", 30, 59.99},
          {"off",
           [](auto& h, const Form& f) {
             bring(h, f, kTarget - 5 - 0.3 * f.number);
             give(h);
             h.go(2, -5);
           },
           false, "off_target", 30, 59.99}};
}

std::vector<Kind> kinds() {
  std::vector<Kind> all = kinds_without_harm();
  const std::vector<Kind> others{
      {"through what is fatal",
       [](auto& h, const Form& f) {
         bring(h, f, 24.5 + 0.4 * f.number);
         h.go(2, kTarget);
         give(h);
         h.go(2, -5);
       },
       false, "fatal:tendon", 5, 19.99},
      {"left in",
       [](auto& h, const Form& f) {
         bring(h, f);
         give(h);
         h.go(f.rest(), kTarget);
       },
       false, "left_in", 20, 39.99},
      {"too fast",
       [](auto& h, const Form& f) {
         bring(h, f);
         give(h, 0.5 + 0.1 * f.number);
         h.go(2, -5);
       },
       false, "fast", 40, 59.99},
      {"forces the syringe",
       [](auto& h, const Form& f) {
         bring(h, f);
         give(h, 0.2, 110 + 20 * f.number);
         h.go(2, -5);
       },
       false, "pressure", 20, 39.99},
      {"wrong side",
       [](auto& h, const Form& f) {
         h.along = along(f) + 10 + f.number;
         h.go(f.way(), kTarget);
         give(h);
         h.go(2, -5);
       },
       false, "off_target", 20, 59.99},
      {"leaves early",
       [](auto& h, const Form& f) {
         bring(h, f, 5 + 0.3 * f.number);
         h.go(f.rest(), 5 + 0.3 * f.number);
         h.go(1, -5);
       },
       false, "off_target", 10, 50},
  };
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

struct Told {
  Judgement judgement;
  Feedback feedback;
};

Told attempt(const Kind& kind, int number) {
  const Form form{number};
  ScriptedHands hands(form.angle(), goals_of());
  kind.act(hands, form);
  const AttemptMeasures m = hands.measure();
  Told told;
  told.judgement = judge(m.metrics, marks_of(m), {}, false);
  told.feedback = make_feedback(m, told.judgement, {3, {}});
  return told;
}

TEST(Verdicts, AHundredAttemptsAreJudgedAsWrittenDown) {
  int wrong = 0;
  for (const Kind& kind : kinds())
    for (int number = 0; number < 10; ++number) {
      const Told told = attempt(kind, number);
      const auto& faults = told.feedback.faults;
      const std::string first = faults.empty() ? "" : faults.front().kind;
      const bool right = told.judgement.passed == kind.passed && first == kind.first &&
                         told.judgement.score >= kind.least && told.judgement.score <= kind.most;
      wrong += right ? 0 : 1;
      EXPECT_TRUE(right) << kind.name << " " << number << ": "
                         << (told.judgement.passed ? "passed" : told.feedback.verdict) << ", "
                         << told.judgement.score << ", first '" << first << "' "
                         << (faults.empty() ? "" : faults.front().what);
      EXPECT_TRUE(faults.empty() || !faults.front().mend.empty());
    }
  EXPECT_EQ(wrong, 0);
}

TEST(Verdicts, AHundredStandsBesideNothingWrong) {
  for (const Kind& kind : kinds())
    for (int number = 0; number < 10; number += 3) {
      const Told told = attempt(kind, number);
      if (told.judgement.score < 100) continue;
      EXPECT_TRUE(told.judgement.passed) << kind.name;
      for (const Fault& fault : told.feedback.faults)
        EXPECT_LT(severity_of_fault(fault.kind), FaultSeverity::purpose) << kind.name;
    }
}

TEST(Verdicts, HarmIsNotPraised) {
  for (const Kind& kind : kinds()) {
    const Told told = attempt(kind, 4);
    if (std::string(kind.first).rfind("fatal", 0) == 0 || std::string(kind.first) == "left_in") {
      EXPECT_EQ(told.feedback.good, "") << kind.name;
    }
    if (std::string(kind.first) == "off_target") {
      EXPECT_EQ(told.feedback.good.find("reached the target"), std::string::npos) << kind.name;
    }
    if (std::string(kind.first) == "unseen") {
      EXPECT_EQ(told.feedback.good.find("sight"), std::string::npos) << told.feedback.good;
    }
  }
}

TEST(Verdicts, ScoresAreInTheOrderOfHarm) {
  for (int number = 0; number < 10; ++number) {
    std::vector<double> scores;
    for (const char* name : {"perfect", "too fast", "off", "left in", "through what is fatal"})
      for (const Kind& kind : kinds())
        if (kind.name == std::string(name)) scores.push_back(attempt(kind, number).judgement.score);
    for (std::size_t i = 1; i < scores.size(); ++i) EXPECT_LT(scores[i], scores[i - 1]) << i;
  }
}

TEST(Verdicts, WhoIsTooLateIsToldAndDoesNotPass) {
  ScriptedHands hands(40, goals_of());
  hands.along = along({4});
  hands.go(4, kTarget);
  give(hands);
  hands.sweep(120);
  hands.go(2, -5);
  const AttemptMeasures m = hands.measure();
  const Judgement judged = judge(m.metrics, marks_of(m), {}, false);
  EXPECT_FALSE(judged.passed);
  EXPECT_LT(judged.score, kFailedScore);
  EXPECT_NEAR(find_metric(m.metrics, "idle_s")->value.value_or(-1), 8, 0.2);  // the syringe's
  const Feedback told = make_feedback(m, judged, {5, {}});
  const bool late = std::any_of(told.faults.begin(), told.faults.end(),
                                [](const Fault& fault) { return fault.kind == "late"; });
  EXPECT_TRUE(late);
}

TEST(Verdicts, WhoFailsWithAidsRepeatsWithThem) {
  AttemptMeasures m;
  m.sought = {{"artery", 2, 4, 2}, {"nerve", 3, -1, 0.7}};
  m.metrics = {{"found", "probe", "count", 1.0, "", {}}};
  const std::vector<Mark> two{*parse_mark("found", "== 2")};
  const Feedback failed = make_feedback(m, judge(m.metrics, two, {}, true));
  EXPECT_NE(failed.next.find("with the aids"), std::string::npos) << failed.next;
  m.metrics[0].value = 2;
  const Feedback held = make_feedback(m, judge(m.metrics, two, {}, true));
  EXPECT_NE(held.next.find("without aids"), std::string::npos) << held.next;
}

}  // namespace
}  // namespace artus
