// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/scenario.h"

#include <string>

#include <gtest/gtest.h>

#include "artus/detail/training/feedback.h"
#include "artus/detail/training/patient_plans.h"
#include "artus/detail/training/player.h"
#include "artus/detail/training/scenario_check.h"
#include "artus/detail/training/session_meter.h"
#include "artus/detail/training/simulated_attempt.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

Scenario align() {
  return *find_scenario("gel-align");
}

TEST(Scenario, TheBundledOnesAreRead) {
  ASSERT_GE(bundled_scenario_texts().size(), 4U);
  for (const std::string_view text : bundled_scenario_texts()) {
    const auto scenario = parse_scenario(text, "bundled");
    ASSERT_TRUE(scenario) << scenario.error().to_string();
    EXPECT_FALSE(scenario->pass.empty()) << scenario->name;
  }
}

TEST(Scenario, AllThatIsWrongStandsInOneMessage) {
  std::string text = align().text;
  text = changed(text, "level = 2", "level = 12\ncolour = 3");
  text = changed(text, "distance_mm = \"<= 2\"", "distanc_mm = \"<= 2\"");
  text = changed(text, "gauge = 21", "gauge = 17");
  const auto scenario = parse_scenario(text, "mine.toml");
  ASSERT_FALSE(scenario);
  const std::string message = scenario.error().to_string();
  for (const char* part : {"level", "colour", "distanc_mm", "distance_mm", "gauge"})
    EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;
}

TEST(Scenario, APatientStandsInTheTextAndInTheNameOfTheBody) {
  const auto modelled = find_scenario("sasd-lateral-2");
  ASSERT_TRUE(modelled);
  const auto thick = of_patient(*modelled, "fat=15");
  ASSERT_TRUE(thick) << thick.error().to_string();
  EXPECT_EQ(thick->body(), modelled->body().string() + "@fat=15");
  const auto again = of_patient(*thick, "seed=2");
  ASSERT_TRUE(again) << again.error().to_string();
  EXPECT_EQ(again->patient, "seed=2");
  EXPECT_EQ(parse_scenario(again->text, "again")->body(), modelled->body().string() + "@seed=2");
  EXPECT_FALSE(of_patient(align(), "fat=15"));  // a block of gel is nobody's
  EXPECT_FALSE(parse_scenario("patient = \"fat=3\"\n" + align().text, "gel"));
}

TEST(Scenario, PlansFollowThePatientsSkin) {
  Scenario scenario = align();
  const auto scene = *make_gel_scene(*scenario.gel);
  const Vec3 entry = scenario.entry.centre;
  const Vec3 direction = (scenario.target.point - entry).normalized();
  scenario.entry.centre -= 5e-3 * direction;
  const double probe_z = scenario.X_JP.translation().z();
  scenario.X_JP.translation() -= 7e-3 * scenario.X_JP.linear().col(2);
  const Scenario off = scenario;
  follow_patient(scenario, *scene);
  EXPECT_EQ(scenario.entry.centre, off.entry.centre);  // nobody's plans stay
  scenario.patient = "fat=3";
  follow_patient(scenario, *scene);
  EXPECT_LT((scenario.entry.centre - entry).norm(), 1e-6);
  EXPECT_NEAR(scenario.X_JP.translation().z(), probe_z, 1e-6);
  EXPECT_EQ(scenario.target.point, off.target.point);
}

TEST(Scenario, RadiusAndAnglesOfTheEntryAreMarks) {
  const auto marks_of = [](const std::string& text, const std::string& metric) {
    std::string all;
    const auto scenario = parse_scenario(text, "mine.toml");
    EXPECT_TRUE(scenario) << scenario.error().to_string();
    for (const Mark& mark : scenario->pass)
      if (mark.metric == metric) all += mark.text + ";";
    return all;
  };
  EXPECT_EQ(marks_of(align().text, "entry_offset_mm"), "<= 5;");
  EXPECT_EQ(marks_of(align().text, "entry_angle_deg"), "<= 45;");
  EXPECT_EQ(marks_of(changed(align().text, "angle_to = 45", "angle_from = 20\nangle_to = 45"),
                     "entry_angle_deg"),
            ">= 20;<= 45;");
  EXPECT_EQ(marks_of(changed(align().text, "angle_to = 45", ""), "entry_angle_deg"), "");
  EXPECT_EQ(marks_of(changed(align().text, "[pass]", "[pass]\nentry_offset_mm = \"<= 2\""),
                     "entry_offset_mm"),
            "<= 2;");
}

/// Tissue in as few steps as there may be.
PlayOptions coarse() {
  PlayOptions options;
  options.tissue_rate = 10;
  return options;
}

TEST(Player, GoingInElsewhereDoesNotPass) {
  const auto scene = *make_gel_scene(*align().gel);
  Scenario scenario = align();
  PlayOptions rigid;  // of marks, not of tissue
  rigid.rigid = true;
  const auto passes = [&] {
    const auto played = play(scenario, scene, expert_skill(), rigid);
    EXPECT_TRUE(played);
    return played && played->judgement.passed;
  };
  EXPECT_TRUE(passes());
  for (Mark& mark : scenario.pass)
    if (mark.metric == "entry_offset_mm") mark.bound = 0.01;
  EXPECT_FALSE(passes());
}

double number_of(const PlayedAttempt& played, const std::string& name) {
  const Metric* metric = find_metric(played.measures.metrics, name);
  EXPECT_NE(metric, nullptr) << name;
  return metric != nullptr ? metric->value.value_or(-1) : -1;
}

Scenario aligned_with(const std::string& more) {
  const auto scenario = parse_scenario(align().text + more, "mine");
  EXPECT_TRUE(scenario) << scenario.error().to_string();
  return *scenario;
}

TEST(Scenario, TheSyringeHoldsWhatIsToBeGiven) {
  const Scenario scenario = aligned_with("[syringe]\nvolume_ml = 3\nliquid = \"lidocaine\"\n");
  const SyringeChoice syringe = syringe_of(scenario);
  EXPECT_DOUBLE_EQ(syringe.filled, 3e-6);
  EXPECT_EQ(syringe.liquid, "lidocaine");
  EXPECT_EQ(syringe.gauge, scenario.gauge);
  const auto refused = [](const std::string& more) {
    const auto bad = parse_scenario(align().text + more, "mine");
    return bad ? std::string() : bad.error().to_string();
  };
  EXPECT_NE(refused("[syringe]\nvolume_ml = 3\nliquid = \"wine\"\n").find("wine"),
            std::string::npos);
  EXPECT_NE(refused("[syringe]\nvolume_ml = 5\nbarrel_ml = 2\n"), "");
  EXPECT_NE(refused("[syringe]\nvolume_ml = 5\ncolour = 1\n").find("colour"), std::string::npos);
}

TEST(Scenario, HapticAidsReachTheHandAndFadeWithTheirValue) {
  Scenario scenario = align();
  scenario.aids = {{"haptic_guide", 0.5}, {"haptic_wall", 1}};
  scenario.avoid = {{"nerve", 0, true}, {"artery", 0, false}};
  const auto params = make_session_params(scenario);
  ASSERT_TRUE(params);
  EXPECT_DOUBLE_EQ(params->aids.guide, 150);
  EXPECT_DOUBLE_EQ(params->aids.wall, 1000);
  EXPECT_EQ(params->aids.keep_out, "nerve\nartery");
  scenario.aids.clear();
  const auto without = make_session_params(scenario);
  EXPECT_EQ(without->aids.guide + without->aids.wall, 0);
}

TEST(Scenario, VariantsAreOfAJoint) {
  const auto gel = parse_scenario("variants = [\"tear\"]\n" + align().text, "mine");
  ASSERT_FALSE(gel);
  EXPECT_NE(gel.error().to_string().find("variants"), std::string::npos);
  EXPECT_EQ(find_scenario("barbotage-1")->body(), "shoulder+calcific_deposit");
  EXPECT_EQ(find_scenario("sasd-lateral-1")->body(), "shoulder");
}

TEST(Player, HandsDrawBackAndGiveWhatIsAskedAtItsRate) {
  const Scenario scenario = aligned_with("[syringe]\nvolume_ml = 1\nrate_ml_s = 0.2\n");
  const auto scene = *make_gel_scene(*scenario.gel);
  PlayOptions rigid;
  rigid.rigid = true;
  const auto expert = play(scenario, scene, expert_skill(), coarse());
  const auto novice = play(scenario, scene, novice_skill(), rigid);
  ASSERT_TRUE(expert && novice);
  EXPECT_NEAR(number_of(*expert, "given_ml"), 1, 0.05);
  EXPECT_NEAR(number_of(*expert, "flow_mean_ml_s"), 0.2, 0.04);
  EXPECT_EQ(number_of(*expert, "aspirated_first"), 1);
  EXPECT_EQ(number_of(*novice, "aspirated_first"), 0);
  EXPECT_GT(number_of(*novice, "flow_peak_ml_s"), number_of(*expert, "flow_peak_ml_s"));
  const auto dry = play(align(), scene, expert_skill(), rigid);
  ASSERT_TRUE(dry);
  const Metric* given = find_metric(dry->measures.metrics, "given_ml");
  EXPECT_TRUE(given == nullptr || !given->value);
}

TEST(Scenario, ANameThatThereIsNotListsThoseThereAre) {
  const auto scenario = find_scenario("no-such");
  ASSERT_FALSE(scenario);
  EXPECT_NE(scenario.error().message.find("gel-align"), std::string::npos);
}

TEST(Scenario, AidsFadeWithSuccessAndGoOut) {
  EXPECT_DOUBLE_EQ(faded(1, 0), 1);
  EXPECT_DOUBLE_EQ(faded(1, 2), 0.49);
  EXPECT_EQ(faded(1, 7), 0);
}

TEST(ScenarioCheck, SaysWhatCannotBeDone) {
  const auto problems_of = [](const std::string& from, const std::string& to) {
    const auto scenario = parse_scenario(changed(align().text, from, to), "mine");
    EXPECT_TRUE(scenario) << scenario.error().to_string();
    const auto scene = make_gel_scene(*scenario->gel);
    std::string all;
    for (const std::string& p : find_problems(*scenario, *scene)) all += p + "\n";
    return all;
  };
  EXPECT_EQ(problems_of("level = 2", "level = 3"), "");
  EXPECT_NE(problems_of("length = 70", "length = 20").find("needle 20.0 mm long"),
            std::string::npos);
  EXPECT_NE(problems_of("centre = [-26, 0, 0]", "centre = [-26, 0, -20]").find("off the skin"),
            std::string::npos);
  EXPECT_NE(problems_of("point = [5, 0, 20]", "point = [5, 8, 20]").find("plane"),
            std::string::npos);
  EXPECT_NE(problems_of("angle_to = 45", "angle_to = 10").find("degrees to the probe"),
            std::string::npos);
  EXPECT_NE(
      problems_of("point = [5, 0, 20]", "structure = \"liver\"\npoint = [5, 0, 20]").find("liver"),
      std::string::npos);
  EXPECT_NE(problems_of("[pass]", "[[avoid]]\nstructure = \"muscle\"\n[pass]")
                .find("contains the target"),
            std::string::npos);
  EXPECT_NE(problems_of("[probe]", "[probe]\ndepth = 15").find("below the picture"),
            std::string::npos);
  EXPECT_NE(problems_of("[pass]",
                        "[[gel.ball]]\ntissue = \"artery\"\ncentre = [-10.5, 0, 10]\nradius = 3\n"
                        "[[avoid]]\nstructure = \"artery\"\nfatal = true\n[pass]")
                .find("into the zone around artery, which must never be entered"),
            std::string::npos);
}

TEST(Player, TheSameSeedGivesTheSameBytesInACageOfItsOwnOrAnothers) {
  const auto scene = *make_gel_scene(*align().gel);
  PlayOptions options = coarse();
  options.seed = 4;
  const auto one = play(align(), scene, novice_skill(), options);
  options.prepared = make_played_body(align(), *scene);
  ASSERT_NE(options.prepared.tissue, nullptr);
  const auto two = play(align(), scene, novice_skill(), options);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(to_json(one->measures.metrics).dump(), to_json(two->measures.metrics).dump());
  ASSERT_EQ(one->recording.packets.size(), two->recording.packets.size());
  for (std::size_t i = 0; i < one->recording.packets.size(); ++i)
    ASSERT_EQ(digest_of(one->recording.packets[i].packet),
              digest_of(two->recording.packets[i].packet));
}

TEST(Player, AnotherSeedIsAnotherAttempt) {
  const auto scene = *make_gel_scene(*align().gel);
  PlayOptions options;
  options.rigid = true;
  options.seed = 4;
  const auto one = play(align(), scene, novice_skill(), options);
  options.seed = 5;
  const auto other = play(align(), scene, novice_skill(), options);
  ASSERT_TRUE(one && other);
  EXPECT_NE(to_json(one->measures.metrics).dump(), to_json(other->measures.metrics).dump());
}

TEST(Player, ALookingTaskIsPlayedAndJudgedWithoutNeedleAndAids) {
  const Scenario look = *find_scenario("gel-look");
  ASSERT_TRUE(look.aided());
  const auto scene = *make_gel_scene(*look.gel);
  const auto params = make_session_params(look);
  ASSERT_TRUE(params);
  PlayOptions rigid;
  rigid.rigid = true;
  const auto played = play(look, scene, expert_skill(), rigid);
  ASSERT_TRUE(played);
  EXPECT_TRUE(played->judgement.passed);
  EXPECT_FALSE(played->judgement.with_aids);
  ASSERT_EQ(played->measures.sought.size(), 5U);
  EXPECT_TRUE(played->measures.needle.empty());
  for (const TickRecord& tick : played->recording.ticks)
    ASSERT_EQ(tick.input.device.has_needle, 0U);
  Scenario impossible = look;
  impossible.find = {"artery", "skin", "liver"};
  EXPECT_FALSE(play(impossible, scene, expert_skill(), {}));

  Recording recording;
  const auto again = make_simulated_attempt(look, scene, *params, expert_skill(), rigid, recording);
  AttemptMeter meter(scene, *make_meter_options(look, scene->joint(), *params));
  while (again->step(meter)) {
  }
  EXPECT_EQ(recording.ticks.size(), played->recording.ticks.size());
  EXPECT_EQ(to_json(meter.measure().metrics).dump(), to_json(played->measures.metrics).dump());
}

TEST(Scenario, AFindTaskHasNoNeedleAndBallsLieApartInOneLayer) {
  const std::string look = find_scenario("gel-look")->text;
  const auto told = [&](const std::string& from, const std::string& to) {
    const auto scenario = parse_scenario(changed(look, from, to), "mine");
    return scenario ? std::string() : scenario.error().message;
  };
  EXPECT_EQ(told("level = 0", "level = 1"), "");
  EXPECT_NE(told("[aids]", "[target]\npoint = [0, 0, 1]\n[needle]\ngauge = 22\n[aids]")
                .find("cannot be combined with find"),
            std::string::npos);
  EXPECT_NE(told("find = [\"artery\", \"bone\", \"tendon\", \"fat\", \"nerve\"]", "find = []")
                .find("1 to 12"),
            std::string::npos);
  EXPECT_NE(told("centre = [26, -22, 14]", "centre = [26, -22, 4]").find("in one layer"),
            std::string::npos);
  EXPECT_NE(told("centre = [26, -22, 14]", "centre = [53, -22, 14]").find("in the block"),
            std::string::npos);
  EXPECT_NE(told("centre = [22, 16, 16]", "centre = [26, -20, 16]").find("apart"),
            std::string::npos);
  EXPECT_NE(told("radius = 4", "radius = \"big\"").find("radius"), std::string::npos);
}

class PlayerFiles : public test::TemporaryFolder {};

TEST_F(PlayerFiles, ARecordedAttemptIsAssessedToTheSameDigits) {
  const auto scene = *make_gel_scene(*align().gel);
  PlayOptions options = coarse();
  options.picture_rate = 0.3;
  const auto played = play(align(), scene, expert_skill(), options);
  ASSERT_TRUE(played);
  ASSERT_TRUE(write_recording(played->recording, in("session.rec")));
  const auto recording = read_recording(in("session.rec"));
  ASSERT_TRUE(recording) << recording.error().to_string();
  EXPECT_TRUE(recording->complete);
  const auto meter = make_meter_options(align(), scene->joint(), recording->head.params);
  const auto assessed = assess(*recording, scene, *meter, SightSource::recorded);
  ASSERT_TRUE(assessed);
  EXPECT_EQ(to_json(assessed->metrics).dump(), to_json(played->measures.metrics).dump());
}

TEST(ScenarioCheck, NovicesStopWhenEnoughHaveFailed) {
  EXPECT_EQ(deciding_failures(1), 1);
  EXPECT_EQ(deciding_failures(3), 2);
  EXPECT_EQ(deciding_failures(20), 12) << "with 8 that pass it is still good";
}

TEST(Player, AnExpertPassesAndANoviceRarely) {
  const auto scene = *make_gel_scene(*align().gel);
  const auto difficulty = measure_difficulty(align(), scene, {20, 1}, {});
  ASSERT_TRUE(difficulty);
  EXPECT_GE(difficulty->rigid.expert.passes, 19);
  EXPECT_LE(difficulty->rigid.novice.passes, 8);
  EXPECT_EQ(difficulty->soft.tries, 1);
  EXPECT_EQ(difficulty->soft.expert.passes, 1);
  EXPECT_EQ(difficulty->compared, 2);
  EXPECT_EQ(difficulty->alike, 2);
}

TEST(Feedback, NamesThreeFaultsAtMostWorstFirstWithCauseAndMend) {
  const auto scene = *make_gel_scene(*align().gel);
  PlayOptions options;
  options.rigid = true;  // of words, not of tissue
  bool faulty = false;
  for (options.seed = 1; options.seed <= 2; ++options.seed) {
    const auto played = play(align(), scene, novice_skill(), options);
    const Feedback feedback = make_feedback(played->measures, played->judgement);
    EXPECT_LE(feedback.faults.size(), 3U);
    EXPECT_FALSE(feedback.next.empty());
    for (std::size_t i = 0; i < feedback.faults.size(); ++i) {
      EXPECT_FALSE(feedback.faults[i].cause.empty());
      EXPECT_FALSE(feedback.faults[i].mend.empty());
      if (i > 0) {
        EXPECT_GE(feedback.faults[i - 1].weight, feedback.faults[i].weight);
      }
    }
    faulty = faulty || !feedback.faults.empty();
  }
  EXPECT_TRUE(faulty);
}

}  // namespace
}  // namespace artus
