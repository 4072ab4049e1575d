// SPDX-License-Identifier: AGPL-3.0-or-later
// What people read of numbers and records is in their language, and nothing has a raw name.
#include <string>

#include <gtest/gtest.h>

#include "artus/detail/core/text_file.h"
#include "artus/detail/reports/logbook_page.h"
#include "artus/detail/reports/mark_words.h"
#include "artus/detail/reports/number_words.h"
#include "artus/detail/training/metrics/attempt_metrics.h"
#include "tests/support/temporary_folder.h"
#include "tests/training/scripted_hands.h"

namespace artus {
namespace {

/// All numbers of an attempt with everything in it.
std::vector<Metric> all_metrics() {
  Goals goals = test::bursa_goals(test::make_layered_scene()->joint());
  goals.entry = Vec3::Zero();
  goals.sought = {"bursa"};
  goals.avoid.push_back({"tendon", goals.target->body, 0, true});
  test::ScriptedHands hands(35, goals);
  hands.go(3, 23);
  hands.inject(3, -0.01, -10);
  hands.inject(2, 0.2, 40);
  hands.go(2, -5);
  return hands.measure().metrics;
}

TEST(NumberWords, EveryMetricHasAShortNameAndASentenceInBothLanguages) {
  for (const std::string& name : metric_names()) {
    EXPECT_EQ(metric_words(Language::english, name).find('_'), std::string::npos) << name;
    EXPECT_EQ(metric_words(Language::french, name).find('_'), std::string::npos) << name;
  }
  const auto metrics = all_metrics();
  EXPECT_GT(metrics.size(), 60U);
  for (const Metric& m : metrics) {
    EXPECT_EQ(metric_words(Language::french, m.name).find('_'), std::string::npos) << m.name;
    EXPECT_EQ(number_words(Language::english, m.definition), m.definition);
    EXPECT_NE(number_words(Language::french, m.definition), m.definition) << m.name;
    EXPECT_NE(number_words(Language::french, m.rule.filter), m.rule.filter) << m.name;
    EXPECT_NE(number_words(Language::french, m.role), m.role) << m.name;
  }
}

TEST(MarkWords, NameStructuresAsPeopleDo) {
  EXPECT_EQ(metric_words(Language::english, "avoid_depth_mm:humeral_cartilage"),
            "depth in structures to avoid, mm (humeral cartilage)");
}

class LogbookPage : public test::TemporaryFolder {};

TEST_F(LogbookPage, SaysByProcedureWhatWasDoneAndWhatIsDueAgain) {
  auto records = Records::open(in("records.db"));
  ASSERT_TRUE(records);
  ASSERT_TRUE(records->add_person({"grey-heron-42", "learner", ""}));
  AttemptRecord attempt;
  attempt.id = "a1";
  attempt.person = "grey-heron-42";
  attempt.scenario = "sasd-lateral-1";
  attempt.scenario_hash = text_hash("text");
  attempt.started = "2026-01-05T10:00:00Z";
  ASSERT_TRUE(records->begin(attempt, "text"));
  attempt.ended = "2026-01-05T10:01:00Z";
  attempt.passed = true;
  attempt.score = 100;
  ASSERT_TRUE(records->finish(attempt, {}, {}));
  for (const auto& [language, due] :
       {std::pair(Language::english, "due again"), {Language::french, "à refaire"}}) {
    ASSERT_TRUE(write_logbook_page(*records, "grey-heron-42", "2026-06-01T00:00:00Z", language,
                                   in("logbook.html")));
    const auto page = read_bytes(in("logbook.html"));
    ASSERT_TRUE(page);
    EXPECT_NE(page->find("grey-heron-42"), std::string::npos);
    EXPECT_NE(page->find(procedure_words(language, "sasd_lateral")), std::string::npos);
    EXPECT_NE(page->find("2026-02-02"), std::string::npos);
    EXPECT_NE(page->find(due), std::string::npos);
    EXPECT_EQ(page->find("sasd_lateral"), std::string::npos) << "no raw name";
    EXPECT_NE(page->find("data-name=\""), std::string::npos) << "a phone's cells say what they are";
  }
  EXPECT_FALSE(write_logbook_page(*records, "nobody", "2026-06-01T00:00:00Z", Language::english,
                                  in("none.html")));
}

TEST(ProcedureWords, EveryBundledScenariosProcedureHasSome) {
  for (const std::string_view text : bundled_scenario_texts()) {
    const auto scenario = parse_scenario(text, "bundled");
    ASSERT_TRUE(scenario);
    EXPECT_NE(procedure_words(Language::french, scenario->procedure),
              procedure_words(Language::english, scenario->procedure))
        << scenario->procedure;
  }
}

}  // namespace
}  // namespace artus
