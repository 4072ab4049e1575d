// SPDX-License-Identifier: AGPL-3.0-or-later
// `artus train` as a process: a whole session of someone new by keys and wheel alone, from who to
// the review and the next task; what is kept of it; and what its flags and scripts refuse.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/core/markup.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/reports/feedback_words.h"
#include "artus/detail/reports/mark_words.h"
#include "artus/detail/trainer/desk.h"
#include "artus/detail/trainer/lesson.h"
#include "artus/detail/trainer/pages.h"
#include "artus/detail/trainer/review.h"
#include "artus/detail/training/records.h"
#include "tests/apps/run_tool.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

class Train : public test::TemporaryFolder {
 protected:
  [[nodiscard]] std::filesystem::path records() const { return folder_ / "records.db"; }

  [[nodiscard]] std::vector<AttemptRecord> attempts(const std::string& visit) const {
    auto file = Records::open(folder_ / visit / "records.db");
    EXPECT_TRUE(file) << file.error().to_string();
    return *file->attempts();
  }
};

/// A run of the tool: its script, and what else stands on its command line.
struct Visit {
  std::string name;
  std::string script;
  std::string more;
};

/// Runs of the tool one after the other under one virtual display (one that ends and one that
/// begins may take the same number); each keeps its records in its own folder. Prints "NAME exit
/// CODE".
test::ProcessResult visit(const std::filesystem::path& folder, const std::vector<Visit>& visits) {
  std::string commands;
  for (const Visit& v : visits) {
    const auto own = folder / v.name;
    std::filesystem::create_directories(own);
    std::ofstream(own / "steps.script") << v.script;
    commands += std::string("timeout 120 ") + ARTUS_TOOL + " train " + v.more + " --records " +
                (own / "records.db").string() + " --script " + (own / "steps.script").string() +
                " --language en --width 900 --height 560; echo " + v.name + " exit $?\n";
  }
  return test::run_process({"xvfb-run", "-a", "sh", "-c", commands});
}

std::string many_times(int n, const std::string& step) {
  std::string steps;
  for (int i = 0; i < n; ++i) steps += step;
  return steps;
}

const std::string kWholeSession =
    "page who\nkey ENTER\n"
    "page pseudonym\nkey ENTER\n"
    "page what\nkey DOWN\nkey ENTER\n"
    "page briefing\nkey ENTER\n"
    "page attempt\nawait picture 20\nkey N\nscroll 81\nawait inside 20\nwait 2\nscroll -90\n"
    "await outside 20\nkey F10\n"
    "page end\nkey ENTER\n"
    "page review\nkey RIGHT\nkey F3\nkey U\nkey F6\nkey U\nkey ESCAPE\n"
    "page end\nkey DOWN\nkey DOWN\nkey ENTER\n"
    "page briefing\nkey ESCAPE\n"
    "page what\n" +
    many_times(99, "key DOWN\n") +  // to the last of the page, whatever scenarios there are
    "key ENTER\n"
    "page earlier\nkey ENTER\n"
    "page end\nkey ENTER\n"
    "page review\nkey ESCAPE\n"
    "page end\n";

/// What was kept of an attempt.
void expect_same_as_its_recording(const AttemptRecord& attempt) {
  const std::filesystem::path kept = attempt.folder;
  const auto text = read_bytes(kept / "attempt.json");
  ASSERT_TRUE(text);
  const auto json = nlohmann::json::parse(*text);
  EXPECT_EQ(json["passed"].get<bool>(), attempt.passed);
  const auto live = metrics_from_json(json["metrics"]);
  const Metric* distance = find_metric(live, "distance_mm");
  ASSERT_TRUE(distance != nullptr && distance->value) << "the needle was in the gel";
  EXPECT_LT(*distance->value, 5) << "81 notches are 40.5 mm, to the point 15 + 25.3 mm away";
  const auto assessed =
      test::artus({"assess", (kept / "session.rec").string(), "--scenario", "gel-find", "--json"});
  ASSERT_EQ(assessed.exit_code, 0) << assessed.err;
  const auto again = metrics_from_json(nlohmann::json::parse(assessed.out)["metrics"]);
  ASSERT_EQ(again.size(), live.size());
  std::size_t with_value = 0;
  for (const Metric& metric : live) {
    const Metric* other = find_metric(again, metric.name, metric.role);
    ASSERT_NE(other, nullptr) << metric.name;
    EXPECT_EQ(other->value, metric.value) << metric.name;
    with_value += metric.value ? 1 : 0;
  }
  EXPECT_GT(with_value, 30U);
}

/// Opened again it is told as it was when it was made.
void expect_the_same_when_it_is_looked_at_again(TrainDesk desk, const AttemptRecord& attempt) {
  const auto finished = desk.finished(attempt.person);
  ASSERT_TRUE(finished) << finished.error().to_string();
  ASSERT_EQ(finished->size(), 1U);
  const auto scenario = find_scenario(attempt.scenario);
  const auto scene = make_gel_scene(*scenario->gel);
  ASSERT_TRUE(scene);
  const auto again =
      read_attempt(desk, {attempt.person, *scenario, *scene, {}, {}}, finished->front());
  ASSERT_TRUE(again) << again.error().to_string();
  EXPECT_TRUE(again->finished);
  EXPECT_EQ(again->played.judgement.passed, attempt.passed);
  EXPECT_EQ(again->played.judgement.score, attempt.score);
  EXPECT_EQ(again->played.duration, attempt.duration);
  const auto kept = read_bytes(std::filesystem::path(attempt.folder) / "attempt.json");
  ASSERT_TRUE(kept);
  const auto json = nlohmann::json::parse(*kept);
  EXPECT_EQ(to_json(again->played.measures.metrics), json["metrics"]);
  const auto page = read_bytes(again->report);
  ASSERT_TRUE(page);
  EXPECT_NE(page->find(escape_markup(again->feedback.next)), std::string::npos);
  std::filesystem::remove(std::filesystem::path(attempt.folder) / "session.rec");
  EXPECT_TRUE(desk.finished(attempt.person)->empty()) << "nothing is offered that is not there";
}

TEST_F(Train, SomeoneNewComesFromTheFirstPageToTheReviewAndTheNextTaskByKeysAndWheel) {
  if (!test::has_virtual_display()) GTEST_SKIP() << "xvfb-run is not installed";
  const auto result =
      visit(folder_, {{"whole", kWholeSession, ""},
                      {"closed",
                       "page who\nkey ENTER\npage pseudonym\nkey ENTER\n"
                       "page briefing\nkey ENTER\npage attempt\nawait picture 20\n",
                       "gel-find --igtl 127.0.0.1:0"},
                      {"wrong", "page who\nkey ENTER\npage review\nkey ESCAPE\n", ""}});
  EXPECT_NE(result.out.find("whole exit 0"), std::string::npos) << result.out << result.err;
  EXPECT_NE(result.out.find("closed exit 0"), std::string::npos) << result.out << result.err;
  EXPECT_NE(result.out.find("wrong exit 1"), std::string::npos) << result.out << result.err;
  EXPECT_NE(result.err.find("'pseudonym'"), std::string::npos) << "where it stops: " << result.err;
  EXPECT_NE(result.err.find("'review'"), std::string::npos) << result.err;

  EXPECT_NE(result.err.find("OpenIGTLink: listening"), std::string::npos) << result.err;
  const auto closed = attempts("closed");
  ASSERT_EQ(closed.size(), 1U);
  EXPECT_TRUE(closed.front().ended.empty()) << "it shows as unfinished";

  const auto done = attempts("whole");
  ASSERT_EQ(done.size(), 1U);
  const AttemptRecord& attempt = done.front();
  EXPECT_EQ(attempt.scenario, "gel-find");
  EXPECT_FALSE(attempt.ended.empty());
  EXPECT_EQ(attempt.mode, "test");
  EXPECT_EQ(attempt.device, "hand");
  const std::filesystem::path kept = attempt.folder;
  std::ifstream page(kept / "report.html");
  const std::string report{std::istreambuf_iterator<char>(page), {}};
  EXPECT_NE(report.find("force on the needle's"), std::string::npos) << report.substr(0, 200);
  EXPECT_TRUE(std::filesystem::exists(kept / "scenario.toml"));
  expect_same_as_its_recording(attempt);
  expect_the_same_when_it_is_looked_at_again(
      *TrainDesk::open(folder_ / "whole" / "records.db", folder_ / "whole" / "attempts"), attempt);
}

TEST_F(Train, WhatCannotBeIsRefusedBeforeAWindowIsOpened) {
  const auto scenario = test::artus({"train", "gel-fnd", "--records", records().string()});
  EXPECT_EQ(scenario.exit_code, 1);
  EXPECT_NE(scenario.err.find("gel-find"), std::string::npos) << "the names: " << scenario.err;
}

TEST_F(Train, PseudonymsAreNobodysAndAttemptsAreCounted) {
  auto desk = TrainDesk::open(records(), folder_ / "attempts");
  ASSERT_TRUE(desk) << desk.error().to_string();
  const auto first = desk->add_learner("2026");
  const auto second = desk->add_learner("2026");
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
  EXPECT_EQ(desk->learners()->size(), 2U);
  const auto scenario = find_scenario("gel-find");
  ASSERT_TRUE(scenario);
  auto record = desk->begin(*first, *scenario, "hand");
  ASSERT_TRUE(record) << record.error().to_string();
  EXPECT_TRUE(std::filesystem::is_directory(record->folder));
  EXPECT_EQ(desk->tally(*first, "gel-find")->attempts, 0) << "not finished";
  PlayedAttempt played;
  played.judgement.passed = true;
  played.judgement.score = 100;
  ASSERT_TRUE(desk->finish(*record, played));
  const auto tally = desk->tally(*first, "gel-find");
  EXPECT_EQ(tally->attempts, 1);
  EXPECT_EQ(tally->passes, 1);
  EXPECT_EQ(tally->successes, 1);
  EXPECT_EQ(desk->tally(*second, "")->attempts, 0);
  EXPECT_EQ(desk->tally(*first, "gel-hold")->attempts, 0);
}

TEST(TrainTask, AidsFadeByWhatTheirScenarioSaysAndGoOffWhenTheyAreNotWanted) {
  auto scenario = find_scenario("gel-find");
  ASSERT_TRUE(scenario);
  scenario->aids = {{"labels", 1}, {"tip_marker", 0.5}};
  scenario->fade = "success";
  TrainTally tally;
  tally.attempts = 5;
  tally.successes = 2;
  const auto value = [](const Scenario& s, std::size_t i) {
    return s.aids.at(i).value;
  };
  EXPECT_NEAR(value(with_faded_aids(*scenario, tally, true), 0), 0.49, 1e-12);
  scenario->fade = "trials";
  EXPECT_NEAR(value(with_faded_aids(*scenario, tally, true), 0), std::pow(0.7, 5), 1e-12);
  EXPECT_EQ(value(with_faded_aids(*scenario, tally, true), 1), 0) << "below 0.1 it is off";
  scenario->fade = "none";
  EXPECT_EQ(value(with_faded_aids(*scenario, tally, true), 0), 1);
  EXPECT_FALSE(with_faded_aids(*scenario, tally, false).aided());
}

TEST(TrainTask, TheHandsBeginOffTheSkinAndFromLevelTwoOnBesideThePlane) {
  for (const char* name : {"gel-find", "gel-align"}) {
    const auto scenario = find_scenario(name);
    ASSERT_TRUE(scenario);
    const HandTarget hands = first_hands(*scenario);
    const Vec3 tip_P = scenario->X_JP.inverse() * to_pose(hands.X_WN).translation();
    EXPECT_LT(tip_P.z(), -1e-3) << name;
    EXPECT_NEAR(tip_P.y(), scenario->level >= 2 ? 6e-3 : 0, 1e-9) << name;
  }
}

TEST(TrainTask, TheBeamIsNotOnATipThatLiesBesideIt) {
  const auto scenario = find_scenario("gel-align");
  ASSERT_TRUE(scenario);
  const auto scene = make_gel_scene(*scenario->gel);
  const auto params = make_session_params(*scenario);
  ASSERT_TRUE(scene && params);
  TrainLesson lesson(*scenario, *scene, *params, {}, Language::french);
  for (const double beside : {0.0, 1.5e-3}) {
    HapticSnapshot now;
    now.input.tick = 1;
    now.X_JP = to_plain(scenario->X_JP);
    now.X_JN =
        to_plain(make_pose(Vec3(0, beside, 18e-3), Vec3(1, 0, 0.5).normalized(), Vec3::Zero()));
    NeedleReading needle;
    needle.inside = true;
    const Lesson told = lesson.lead({now, needle});
    EXPECT_EQ(told.title, title_words(Language::french, *scenario));
    EXPECT_EQ(told.beam_on_tip, beside == 0) << beside;
    EXPECT_FALSE(told.over);
  }
}

TEST(TrainTask, ALookingTaskAsksForOneAfterAnotherAndEndsByItself) {
  const auto scenario = find_scenario("gel-look");
  ASSERT_TRUE(scenario);
  const auto scene = make_gel_scene(*scenario->gel);
  const auto params = make_session_params(*scenario);
  ASSERT_TRUE(scene && params);
  EXPECT_EQ(first_hands(*scenario).has_needle, 0U);
  TrainLesson lesson(*scenario, *scene, *params, {}, Language::english);
  std::uint64_t tick = 0;
  Lesson told;
  for (const std::string& name : scenario->find) {
    const auto ball = std::find_if(scenario->gel->balls.begin(), scenario->gel->balls.end(),
                                   [&](const Ball& b) { return b.tissue == name; });
    for (int k = 0; k < 50; ++k) {
      HapticSnapshot now;
      now.input.tick = tick += 40;
      now.input.device.has_probe = 1;
      now.X_JP = to_plain(
          make_pose(Vec3(ball->centre.x(), ball->centre.y(), 0), Vec3::UnitZ(), Vec3::UnitX()));
      told = lesson.lead({now, {}});
      if (k == 0) {
        EXPECT_NE(told.goal.find(name), std::string::npos) << told.goal;
        EXPECT_EQ(told.steps.size(), 5U);
        EXPECT_FALSE(told.over);
      }
    }
  }
  EXPECT_TRUE(std::all_of(told.steps.begin(), told.steps.end(),
                          [](const auto& step) { return step.done; }));
  HapticSnapshot later;
  later.input.tick = tick + 2000;
  EXPECT_TRUE(lesson.lead({later, {}}).over);
}

TEST(TrainTask, EveryBundledScenarioIsSaidInWordsInBothLanguages) {
  for (const std::string_view text : bundled_scenario_texts()) {
    const auto scenario = parse_scenario(text, "bundled");
    ASSERT_TRUE(scenario);
    EXPECT_FALSE(scenario->title_fr.empty()) << scenario->name;
    EXPECT_EQ(title_words(Language::english, *scenario), scenario->title);
    EXPECT_EQ(title_words(Language::french, *scenario), scenario->title_fr);
    for (const Language language : {Language::english, Language::french}) {
      EXPECT_FALSE(goal_words(*scenario, language).empty());
      for (const Mark& mark : scenario->pass)
        EXPECT_NE(metric_words(language, mark.metric), mark.metric)
            << scenario->name << ": no words for " << mark.metric;
      for (const std::string& step : scenario->steps)
        EXPECT_NE(step_words(language, step), step) << scenario->name;
    }
  }
}

TEST(TrainTask, MarksAreSaidWithTheirBounds) {
  const auto mark = parse_mark("distance_mm", "<= 1.5");
  ASSERT_TRUE(mark);
  EXPECT_EQ(mark_words(Language::english, *mark), "tip from the target, mm: at most 1.5");
  EXPECT_EQ(mark_words(Language::french, *mark), "pointe à la cible, mm : au plus 1,5");
  EXPECT_EQ(bound_words(Language::english, *parse_mark("avoid_fatal", "== 0")), "exactly 0");
}

TEST(TrainTask, WhatFeedbackSaysIsSaidInFrenchWithItsNumbersAndStructures) {
  const auto french = [](const char* english) {
    return feedback_words(Language::french, english);
  };
  EXPECT_EQ(french("advanced without seeing the tip: 2.5 mm; should be below 1.0, and onto bone"),
            "avancé sans voir la pointe : 2,5 mm ; devrait être sous 1,0, et jusqu'à l'os");
  EXPECT_EQ(french("bone contacts: 2.0 ; should be below 1.0"),
            "contacts osseux : 2,0  ; devrait être sous 1,0");
  EXPECT_EQ(french("the tip was in the shadow of humerus"),
            "la pointe était dans l'ombre de cette structure : humérus");
  EXPECT_EQ(
      french("1.5 ml with the tip in bursa, without a pause to check where the first drops went"),
      "1,5 ml, pointe dans : bourse, sans pause pour vérifier où vont les premières gouttes");
  EXPECT_EQ(french("the needle's angle to the probe's face: 62.1 degrees; should be below 50.0"),
            "angle de l'aiguille à la face de la sonde : 62,1 degrés ; devrait être sous 50,0");
  EXPECT_EQ(french("a sentence that nobody said"), "a sentence that nobody said");
  EXPECT_EQ(feedback_words(Language::english, "passes"), "passes");
  EXPECT_EQ(feedback_words(Language::english, "the tip was in carpal_tunnel"),
            "the tip was in carpal tunnel");
}

/// No line of what novices are told stays English.
TEST(TrainTask, WhatNovicesAreToldIsThereInFrench) {
  std::size_t lines = 0;
  for (const char* name : {"gel-find", "gel-align", "gel-steep"}) {
    const auto scenario = find_scenario(name);
    const auto scene = make_gel_scene(*scenario->gel);
    ASSERT_TRUE(scene);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      PlayOptions options;
      options.seed = seed;
      options.rigid = true;  // words, not tissue
      const auto played = play(*scenario, *scene, novice_skill(), options);
      ASSERT_TRUE(played);
      const Feedback told = make_feedback(played->measures, played->judgement);
      std::vector<std::string> all{told.next};
      if (!told.good.empty()) all.push_back(told.good);
      for (const Fault& fault : told.faults)
        for (const std::string& line : {fault.what, fault.cause, fault.mend}) all.push_back(line);
      for (const std::string& line : all)
        EXPECT_NE(feedback_words(Language::french, line), line) << name << " " << seed;
      lines += all.size();
    }
  }
  EXPECT_GT(lines, 40U);
}

TEST(TrainTask, AReviewHasTheExpertsRunAndTheTruthOfEachMoment) {
  const auto scenario = find_scenario("gel-align");
  ASSERT_TRUE(scenario);
  const auto scene = make_gel_scene(*scenario->gel);
  ASSERT_TRUE(scene);
  PlayOptions options;
  options.seed = 2;
  options.tissue_rate = 10;
  auto played = play(*scenario, *scene, novice_skill(), options);
  ASSERT_TRUE(played);
  TrainTask task{"someone", *scenario, *scene, {}, {}};
  TrainOutcome outcome;
  outcome.played = std::move(*played);
  const auto review = make_review(task, outcome, Language::english);
  ASSERT_TRUE(review) << review.error().to_string();
  ASSERT_FALSE(review->film.moments.empty());
  EXPECT_NEAR(review->film.length(), outcome.played.duration, 0.1);
  ASSERT_TRUE(review->expert);
  EXPECT_GT(review->expert->contact(), 0);
  EXPECT_GT(review->film.contact(), 0);
  const double inside = review->film.contact() + 0.1;
  EXPECT_NE(review->why(review->film.at(inside).state).find("beside the picture's plane"),
            std::string::npos);
  EXPECT_EQ(review->why(review->film.at(0).state).find("plane"), std::string::npos)
      << "outside there is nothing to see";
  for (const ReviewFault& fault : review->faults) {
    EXPECT_GE(fault.time, 0);
    EXPECT_FALSE(fault.mend.empty());
  }
}

}  // namespace
}  // namespace artus
