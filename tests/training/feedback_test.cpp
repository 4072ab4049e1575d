// SPDX-License-Identifier: AGPL-3.0-or-later
// Attempts whose faults and causes are known, and what their learner is told.
#include "artus/detail/training/feedback.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/training/past_attempts.h"
#include "tests/support/temporary_folder.h"
#include "tests/training/scripted_hands.h"

namespace artus {
namespace {

using test::ScriptedHands;
using testing::HasSubstr;
using testing::Not;

const Fault* fault_of(const Feedback& feedback, const std::string& kind) {
  const auto at = std::find_if(feedback.faults.begin(), feedback.faults.end(),
                               [&](const Fault& fault) { return fault.kind == kind; });
  return at == feedback.faults.end() ? nullptr : &*at;
}

TEST(Feedback, AGoodInjectionHasNoFault) {
  ScriptedHands hands;
  hands.go(4, 23);
  hands.inject(3, -0.01, -10);
  hands.inject(5, 0.2, 40);
  hands.go(2, -5);
  const Feedback told = make_feedback(hands.measure(), {true, false, 100, {}, {}}, {5, {}});
  EXPECT_THAT(told.faults, testing::IsEmpty())
      << told.faults.front().kind << ": " << told.faults.front().what;
  EXPECT_THAT(told.next, HasSubstr("next level"));
}

TEST(Feedback, LiquidInTheWrongLayerIsToldWithLayerMomentAndHaste) {
  ScriptedHands hands;
  hands.go(4, 18);
  const double began = hands.time();
  hands.inject(5, 0.2, 40);
  const AttemptMeasures m = hands.measure();
  const Feedback told = make_feedback(m, {});
  ASSERT_FALSE(told.faults.empty());
  EXPECT_EQ(told.faults.front().kind, "misplaced");
  EXPECT_NEAR(told.faults.front().time, began + 2.5, 0.2);  // half a millilitre
  EXPECT_THAT(told.faults.front().what, HasSubstr("1.0 ml"));
  EXPECT_THAT(told.faults.front().cause, HasSubstr("muscle"));
  EXPECT_THAT(told.faults.front().cause, HasSubstr("without a pause"));
  const Fault* unaspirated = fault_of(told, "unaspirated");
  ASSERT_NE(unaspirated, nullptr);
  EXPECT_NEAR(unaspirated->time, began, 0.2);
  EXPECT_THAT(told.next, HasSubstr("half a ml"));  // the weakest skill
}

TEST(Feedback, ANeedleThatWasNeverInIsToldFirst) {
  ScriptedHands hands;
  hands.go(4, -5);
  Judgement judgement;
  judgement.marks.push_back({*parse_mark("distance_mm", "<= 2"), std::nullopt, false});
  const Feedback told = make_feedback(hands.measure(), judgement);
  ASSERT_FALSE(told.faults.empty());
  EXPECT_EQ(told.faults.front().kind, "never_in");
  EXPECT_THAT(told.faults.front().mend, HasSubstr("advance"));
}

TEST(Feedback, PressureAndHasteAreToldAtTheirPeaks) {
  ScriptedHands hands;
  hands.go(4, 23);
  hands.inject(3, -0.01, -10);
  hands.inject(2, 0.2, 40);
  const double pressed = hands.time();
  hands.inject(1, 0.6, 180);
  hands.inject(2, 0.2, 40);
  const Feedback told = make_feedback(hands.measure(), {});
  EXPECT_EQ(fault_of(told, "misplaced"), nullptr);
  EXPECT_EQ(fault_of(told, "unaspirated"), nullptr);
  const Fault* pressure = fault_of(told, "pressure");
  ASSERT_NE(pressure, nullptr);
  EXPECT_NEAR(pressure->time, pressed, 0.1);
  EXPECT_THAT(pressure->what, HasSubstr("180.0 kPa"));
  EXPECT_THAT(pressure->cause, HasSubstr("bursa"));
  const Fault* fast = fault_of(told, "fast");
  ASSERT_NE(fast, nullptr);
  EXPECT_NEAR(fast->time, pressed, 0.1);
  EXPECT_THAT(fast->cause, HasSubstr("20 N"));
}

TEST(Feedback, DriftIsShownWhereTheProbeWasFastest) {
  ScriptedHands hands;
  hands.go(2, 8);
  const double slid = hands.time();
  hands.go(1, 12, 6);
  hands.go(2, 20);
  const Feedback told = make_feedback(hands.measure(), {});
  const Fault* drift = fault_of(told, "drift");
  ASSERT_NE(drift, nullptr);
  EXPECT_GT(drift->time, slid);
  EXPECT_LT(drift->time, slid + 1);
  EXPECT_THAT(drift->cause, HasSubstr("mm/s"));
}

TEST(Feedback, ATipBesideThePlaneAndASteepNeedleAreToldApart) {
  ScriptedHands aside;
  aside.aside = -2.1;
  aside.go(4, 20);
  const Feedback beside = make_feedback(aside.measure(), {});
  const Fault* unseen = fault_of(beside, "unseen");
  ASSERT_NE(unseen, nullptr);
  EXPECT_THAT(unseen->cause, HasSubstr("2.1 mm behind the plane"));
  EXPECT_THAT(unseen->mend, HasSubstr("move the probe"));
  ScriptedHands steep(80);
  steep.go(4, 20);
  const Feedback upright = make_feedback(steep.measure(), {});
  unseen = fault_of(upright, "unseen");
  ASSERT_NE(unseen, nullptr);
  EXPECT_THAT(unseen->cause, HasSubstr("80 degrees"));
  EXPECT_THAT(unseen->cause, HasSubstr("dB lost to the angle"));
  EXPECT_THAT(unseen->cause, Not(HasSubstr(" 0 dB")));
  EXPECT_THAT(unseen->mend, HasSubstr("Enter further"));
}

TEST(Feedback, TheWayToThePicturesEdgeIsNobodysFault) {
  ScriptedHands flat(
      15);  // comes in 30 mm beside the probe's middle, whose picture is 20 mm wide there
  flat.go(4, 15);
  const AttemptMeasures m = flat.measure();
  const Metric* unseen = find_metric(m.metrics, "unseen_mm");
  const Metric* entry = find_metric(m.metrics, "unseen_entry_mm");
  ASSERT_TRUE(unseen != nullptr && entry != nullptr && unseen->value && entry->value);
  EXPECT_GT(*entry->value, 10);
  EXPECT_NEAR(*unseen->value, *entry->value, 1);
  EXPECT_EQ(fault_of(make_feedback(m, {}), "unseen"), nullptr);
  EXPECT_THAT(past_attempt(0, m.metrics).kinds, Not(testing::Contains("unseen")));
  ScriptedHands beside(15);
  beside.go(1, 3);  // never in the picture
  const AttemptMeasures never = beside.measure();
  EXPECT_EQ(find_metric(never.metrics, "unseen_entry_mm")->value, 0);
  EXPECT_NE(fault_of(make_feedback(never, {}), "unseen"), nullptr);
}

TEST(Feedback, AFaultOfTheAttemptBeforeWeighsHalfAsMuchAgain) {
  ScriptedHands hands;
  hands.go(2, 8);
  hands.go(1, 12, 6);
  hands.go(2, 20);
  const AttemptMeasures m = hands.measure();
  const double once = fault_of(make_feedback(m, {}), "drift")->weight;
  const PastAttempt same{1, false, {"drift"}};
  const PastAttempt other{1, false, {"bone"}};
  EXPECT_EQ(fault_of(make_feedback(m, {}, {0, {other, same}}), "drift")->weight, 1.5 * once);
  EXPECT_EQ(fault_of(make_feedback(m, {}, {0, {same, other}}), "drift")->weight, once);
}

TEST(Feedback, IdleTimesAreToldFromLevelFiveOn) {
  ScriptedHands hands;
  hands.go(3, 15);
  hands.go(15, 15);
  hands.go(1, 23);
  const AttemptMeasures m = hands.measure();
  EXPECT_EQ(fault_of(make_feedback(m, {}, {4, {}}), "idle"), nullptr);
  const Feedback told = make_feedback(m, {}, {5, {}});
  ASSERT_NE(fault_of(told, "idle"), nullptr);
  EXPECT_THAT(fault_of(told, "idle")->cause, HasSubstr("nothing moved"));
}

TEST(Feedback, ANeedleThatRestsWhileSomethingIsGivenIsNotIdle) {
  ScriptedHands hands;
  hands.go(3, 15);
  hands.inject(15, 0.1, 20);
  hands.go(1, 23);
  EXPECT_EQ(fault_of(make_feedback(hands.measure(), {}, {5, {}}), "idle"), nullptr);
}

TEST(Feedback, TheNextTaskIsOfTheWeakestSkillAndOldPracticeFades) {
  ScriptedHands hands;
  hands.go(4, 23);
  const AttemptMeasures clean = hands.measure();
  const Judgement passed{true, false, 100, {}, {}};
  const auto next = [&](std::vector<PastAttempt> before) {
    const Feedback told = make_feedback(clean, passed, {0, std::move(before)});
    EXPECT_EQ(told.next.find("gel-"), std::string::npos) << "no raw name: " << told.next;
    return told.next_scenario.empty() ? told.next : told.next_scenario;
  };
  EXPECT_THAT(next({}), HasSubstr("next level"));
  const PastAttempt bone{1, false, {"bone"}};
  EXPECT_THAT(next({bone, bone, bone}), HasSubstr("gel-align"));
  const PastAttempt drift{1, false, {"drift"}};
  EXPECT_THAT(next({bone, bone, bone, drift, drift}), HasSubstr("gel-align"));
  EXPECT_THAT(next({bone, bone, drift, drift, drift}), HasSubstr("gel-hold"));
  const PastAttempt lately{1, false, {}};
  const PastAttempt long_ago{60, false, {}};
  EXPECT_THAT(next({lately, lately, lately}), HasSubstr("next level"));
  EXPECT_THAT(next({long_ago, long_ago, long_ago}), HasSubstr("gel-find"));  // looking first
}

TEST(Feedback, WhoDidNotFindWhatWasAskedForIsToldWhyAndLooksAgain) {
  AttemptMeasures m;
  m.sought = {{"artery", 2, 4, 2}, {"nerve", 3, -1, 0.7}};
  m.metrics = {{"found", "probe", "count", 1.0, "", {}}, {"find_s", "probe", "s", {}, "", {}}};
  m.events = {{4, "found", "artery", 4, ""}, {60, "not_found", "nerve", 0.7, "why"}};
  const Feedback told = make_feedback(m, {}, {});
  const Fault* fault = fault_of(told, "not_found");
  ASSERT_NE(fault, nullptr);
  EXPECT_EQ(fault->what, "shown: 1 of 2; not shown: nerve");
  EXPECT_EQ(fault->cause, "why");
  EXPECT_EQ(told.next_scenario, "gel-look");
  const PastAttempt past = past_attempt(1, m.metrics);
  EXPECT_TRUE(past.looked);
  EXPECT_THAT(past.kinds, testing::Contains("not_found"));
  // What was looked for says nothing of the needle, nor the other way round.
  ScriptedHands hands;
  hands.go(4, 23);
  const Judgement passed{true, false, 100, {}, {}};
  EXPECT_EQ(make_feedback(hands.measure(), passed, {0, {past, past, past}}).next_scenario,
            "gel-look");
  m.metrics = {{"found", "probe", "count", 2.0, "", {}}, {"find_s", "probe", "s", 9.0, "", {}}};
  m.sought[1].found = 9;
  m.events.pop_back();
  const Feedback good = make_feedback(m, passed, {});
  EXPECT_EQ(good.good, "You found all that was asked for.");
  EXPECT_TRUE(good.faults.empty());
}

TEST(Feedback, PastAttemptsAreReadFromTheirNumbers) {
  ScriptedHands hands;
  hands.go(4, 18, 8);
  hands.inject(2, 0.6, 180);
  const AttemptMeasures m = hands.measure();
  const PastAttempt past = past_attempt(3, m.metrics);
  EXPECT_EQ(past.weeks, 3);
  EXPECT_TRUE(past.injected);
  for (const Fault& fault : make_feedback(m, {}).faults)
    EXPECT_THAT(past.kinds, testing::Contains(fault.kind));
  for (const char* kind : {"drift", "misplaced", "unaspirated", "pressure", "fast"})
    EXPECT_THAT(past.kinds, testing::Contains(kind));
  for (const std::string& kind : {std::string("misplaced"), std::string("fast")})
    EXPECT_EQ(skill_of_fault(kind), Skill::inject);
}

class FeedbackRecords : public test::TemporaryFolder {};

TEST_F(FeedbackRecords, FinishedAttemptsWithoutAidsCountByTheirAge) {
  auto records = Records::open(in("school.db"));
  ASSERT_TRUE(records);
  ASSERT_TRUE(records->add_person({"p", "learner", ""}));
  const std::vector<Metric> drift{{"drift_mm_s", "probe", "mm/s", 3.0, "", {}}};
  AttemptRecord a;
  a.person = "p";
  a.scenario = "gel-hold";
  for (const bool aided : {false, true}) {
    a.id = aided ? "aided" : "counts";
    a.started = "2026-01-01T00:00:00Z";
    a.aided = aided;
    ASSERT_TRUE(records->begin(a, "text"));
    a.ended = "2026-01-01T00:01:00Z";
    ASSERT_TRUE(records->finish(a, drift, {}));
    a.ended.clear();
  }
  a.aided = false;
  for (const char* id : {"unfinished", "this one", "later"}) {
    a.id = id;
    a.started = a.id == "unfinished" ? "2026-01-02T00:00:00Z" : "2026-01-15T00:00:00Z";
    ASSERT_TRUE(records->begin(a, "text"));
    if (a.id != "later") continue;
    ASSERT_TRUE(records->finish(a, drift, {}));
  }
  a.id = "this one";
  const auto before = read_past_attempts(*records, a);
  ASSERT_TRUE(before);
  ASSERT_EQ(before->size(), 1U);
  EXPECT_NEAR(before->front().weeks, 2, 1e-9);
  EXPECT_THAT(before->front().kinds, testing::ElementsAre("drift"));
}

}  // namespace
}  // namespace artus
