// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/three_injections.h"

#include <algorithm>
#include <clocale>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/evidence/runs/run_doses.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

const std::vector<PlannedInjection> kPlans{{"first", {-.02, 0, 0}, {-.012, 0, .0235}},
                                           {"second", {-.02, 0, 0}, {-.015, .002, .0235}},
                                           {"third", {-.02, .003, 0}, {-.014, .003, .0235}}};

Scene six_layers() {
  const std::vector<test::FlatLayer> layers{{"skin", .004},   {"muscle", .018},    {"bursa", .003},
                                            {"tendon", .006}, {"cartilage", .003}, {"bone", .03}};
  return Scene(std::make_shared<const CompiledJoint>(test::make_layered_block(layers, .2, .2)));
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

// One body and one run serve all tests: running is the slow part.
const Scene& scene() {
  static const Scene kScene = six_layers();
  return kScene;
}

const ThreeInjections& first_run() {
  static const ThreeInjections kRun = run_three_injections(scene(), kPlans).value();
  return kRun;
}

TEST(ThreeInjections, EveryClaimOfThePublishedTestHolds) {
  for (const Claim& c : first_run().claims)
    EXPECT_TRUE(c.pass) << c.text << ": " << c.value << ' ' << c.bound;
}

// What the test shows of force and probe was put in: it checks the machinery and proves nothing.
TEST(ThreeInjections, ClaimsAreInputsAndSayOfWhat) {
  for (const Claim& c : first_run().claims) {
    EXPECT_EQ(c.basis.kind, ClaimKind::input) << c.text;
    EXPECT_FALSE(c.basis.why.empty()) << c.text;
  }
}

TEST(ThreeInjections, BoneIsTouchedByAllAndBothSlowOnesTakeANewLine) {
  const auto value_of = [](const std::string& text) {
    for (const Claim& c : first_run().claims)
      if (c.text == text) return c.value;
    return -1.0;
  };
  EXPECT_EQ(value_of("injections that touch bone"), 3);
  EXPECT_EQ(value_of("injections that took a new line, of those re-aimed"), 2);
}

TEST(ThreeInjections, EachLayersPlateauIsItsTableForceWithinTwoPercent) {
  const std::vector<std::pair<std::string, double>> table{
      {"skin", 1}, {"muscle", 2}, {"bursa", 1.5}, {"tendon", 2.5}, {"cartilage", 3}, {"bone", 4}};
  ASSERT_EQ(first_run().plateaus.size(), table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_EQ(first_run().plateaus[i].tissue, table[i].first);
    EXPECT_NEAR(first_run().plateaus[i].mean, table[i].second, 0.02 * table[i].second);
    EXPECT_GE(first_run().plateaus[i].rows, 10U);
  }
}

TEST(ThreeInjections, MomentsTellTheStoryInOrder) {
  std::vector<std::string> first;
  for (const NamedMoment& m : first_run().moments) {
    if (m.pass == 1) first.push_back(m.label);
  }
  EXPECT_THAT(first, ::testing::ElementsAre("skin punctured", "bursa reached", "withdrawn",
                                            "re-aimed", "second part of bursa reached",
                                            "bone touched", "bone pressed", "needle out"));
}

TEST(ThreeInjections, ADoseIsGivenAtEachTargetAndTheBursaHasIt) {
  ThreeInjectionsOptions options;
  options.dose.volume = 0.2e-6;
  options.dose.rate = 0.2e-6;
  const ThreeInjections run = run_three_injections(scene(), kPlans, options).value();
  for (const Claim& c : run.claims)
    EXPECT_TRUE(c.pass) << c.text << ": " << c.value << ' ' << c.bound;
  ASSERT_EQ(run.syringe.size(), run.rows.size());
  EXPECT_NEAR(run.asked, 0.8e-6, 1e-15) << "the third goes straight to the bone";
  EXPECT_TRUE(run.into_cavity);
  double given = 0;
  for (const GivenTo& to : run.given) given += to.volume;
  EXPECT_NEAR(given, run.syringe.back().plunger.given, 1e-15);
  EXPECT_NEAR(given, run.asked, 0.02 * run.asked);
  ASSERT_GT(run.syringe.back().n_sites, 0U);
  EXPECT_EQ(run.region_names[run.syringe.back().sites[0].region], "bursa");
  EXPECT_EQ(std::count_if(run.moments.begin(), run.moments.end(),
                          [](const NamedMoment& m) {
                            return m.label.find(" injected") != std::string::npos;
                          }),
            4);
  EXPECT_TRUE(first_run().syringe.empty()) << "dry unless a dose is asked for";
  EXPECT_TRUE(first_run().given.empty());
}

/// The opening of 18 G is 3.2 mm long and the bursa 2 mm thick along the line: what of it fits,
/// fits.
TEST(ThreeInjections, AWideNeedlesOpeningIsAsDeepInTheTargetAsThereIsRoom) {
  ThreeInjectionsOptions options;
  options.dose.volume = 0.2e-6;
  options.dose.rate = 0.2e-6;
  options.dose.syringe.gauge = 18;
  const ThreeInjections run = run_three_injections(scene(), kPlans, options).value();
  double given = 0;
  double there = 0;
  for (const GivenTo& to : run.given) {
    given += to.volume;
    if (to.target) there += to.volume;
  }
  EXPECT_NEAR(given, run.asked, 0.02 * run.asked);
  EXPECT_GE(there, 0.95 * given);
}

TEST(ThreeInjections, ABursaThatGotNothingFailsAndADoseWithoutARateIsRefused) {
  ThreeInjectionsOptions options;
  options.dose.volume = 0.2e-6;
  ThreeInjections empty;
  empty.syringe.resize(1);
  empty.into_cavity = true;
  claim_doses(empty);
  ASSERT_EQ(empty.claims.size(), 2U);
  EXPECT_FALSE(empty.claims.back().pass) << "nothing came into the bursa";
  options.dose.rate = 0;
  EXPECT_FALSE(run_three_injections(scene(), kPlans, options));
}

TEST(ThreeInjections, ProbePlaneHoldsTheNeedleAndTheFootprintIsOnTheSkin) {
  for (const NamedMoment& m : first_run().moments) {
    const Vec3 in_seat = m.X_JP_seat.inverse() * Vec3(m.X_JN.translation());
    EXPECT_NEAR(in_seat.y(), 0, 1e-9) << m.label;
    EXPECT_NEAR(m.X_JP_seat.translation().z(), 0, 1e-6) << m.label;
    // The hand brings it there within the slice's thickness at its thinnest.
    const Vec3 in_probe = m.X_JP.inverse() * Vec3(m.X_JN.translation());
    EXPECT_NEAR(in_probe.y(), 0, 0.2e-3) << m.label;
    EXPECT_NEAR(m.X_JP.translation().z(), 0, 0.2e-3) << m.label;
    for (const float c : m.coverage) EXPECT_EQ(c, 1) << m.label;
  }
}

TEST(ThreeInjections, ProbeComesOntoTheSkinSlidesAndLeavesIt) {
  const ThreeInjections& run = first_run();
  ASSERT_EQ(run.probe.size(), run.rows.size());
  EXPECT_EQ(run.probe.front().contact_share, 0);
  EXPECT_EQ(run.probe.front().normal_force, 0);
  EXPECT_EQ(run.probe.back().contact_share, 0);
  EXPECT_EQ(run.probe.back().normal_force, 0);
  double slipped = 0;
  double pressed = 0;
  for (const ProbeHandRow& row : run.probe) {
    slipped = std::max(slipped, row.slip);
    pressed = std::max(pressed, row.normal_force);
    EXPECT_NEAR(row.friction.dot(row.X_JP.linear().col(2)), 0, 1e-12);
  }
  EXPECT_GT(slipped, 1e-3);  // from one line of injection to the next
  EXPECT_LT(pressed, 1.5 * run.options.probe.press_force);
}

TEST(ThreeInjections, ProbeThatIsNotPressedFeelsAlmostNothing) {
  ThreeInjectionsOptions lifted;
  lifted.probe.press_force = 0;
  lifted.probe.contact.gel = false;
  const ThreeInjections run = run_three_injections(scene(), kPlans, lifted).value();
  const Claim* held = nullptr;
  for (const Claim& c : run.claims) {
    if (c.text == "probe: mean force of the skin while it is held") held = &c;
  }
  ASSERT_NE(held, nullptr);
  EXPECT_LT(held->value, 0.05);
}

TEST(ThreeInjections, SameSeedGivesTheSameBytesInAnyLocaleAndAnotherSeedDoesNot) {
  const auto folder = std::filesystem::temp_directory_path() / "artus-three-injections-test";
  std::filesystem::create_directories(folder);
  const ThreeInjections again = run_three_injections(scene(), kPlans).value();
  ASSERT_TRUE(write_needle_csv(folder / "a.csv", first_run().rows, first_run().region_names));
  const bool german = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  ASSERT_TRUE(write_needle_csv(folder / "b.csv", again.rows, again.region_names));
  if (german) std::setlocale(LC_ALL, "C");
  EXPECT_EQ(bytes_of(folder / "a.csv"), bytes_of(folder / "b.csv"));
  ThreeInjectionsOptions other;
  other.seed = 2;
  const ThreeInjections different = run_three_injections(scene(), kPlans, other).value();
  ASSERT_TRUE(write_needle_csv(folder / "c.csv", different.rows, different.region_names));
  EXPECT_NE(bytes_of(folder / "a.csv"), bytes_of(folder / "c.csv"));
  std::filesystem::remove_all(folder);
}

TEST(ThreeInjections, ATargetInBoneWithoutABursaMeansTheLastLayerBeforeTheBone) {
  const std::vector<test::FlatLayer> layers{
      {"skin", .004}, {"muscle", .018}, {"tendon", .010}, {"bone", .03}};
  const Scene dry(std::make_shared<const CompiledJoint>(test::make_layered_block(layers, .2, .2)));
  auto plans = kPlans;
  for (PlannedInjection& plan : plans) plan.target.z() = .035;  // 3 mm inside the bone
  const auto run = run_three_injections(dry, plans);
  ASSERT_TRUE(run) << run.error().to_string();
  EXPECT_EQ(run->touches.size(), 3U);
  const auto reached =
      std::count_if(run->moments.begin(), run->moments.end(),
                    [](const NamedMoment& m) { return m.label == "tendon reached"; });
  EXPECT_EQ(reached, 2);
}

TEST(ThreeInjections, OnAJointWhoseBursaNoLineReachesDoNotHold) {
  const std::vector<test::FlatLayer> layers{
      {"skin", .004}, {"muscle", .018}, {"tendon", .010}, {"bone", .03}, {"bursa", .003}};
  const Scene behind(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, .2, .2)));
  auto plans = kPlans;
  for (PlannedInjection& plan : plans) plan.target.z() = .035;  // in the bone before the bursa
  const auto run = run_three_injections(behind, plans);
  ASSERT_TRUE(run) << run.error().to_string();
  EXPECT_FALSE(all_hold(run->claims));
  const auto claim = std::find_if(run->claims.begin(), run->claims.end(), [](const Claim& c) {
    return c.text == "injections that reach a bursa";
  });
  ASSERT_NE(claim, run->claims.end());
  EXPECT_EQ(claim->value, 0);
  EXPECT_FALSE(tell_lack_of_evidence(run->claims).empty());
}

TEST(ThreeInjections, PlansThatCannotBeRunAreRefused) {
  EXPECT_FALSE(run_three_injections(scene(), std::span(kPlans).first(2)));
  ThreeInjectionsOptions unknown;
  unknown.device = "phantom";
  EXPECT_FALSE(run_three_injections(scene(), kPlans, unknown));
  auto astray = kPlans;
  astray[1].target = Vec3(0, 0, -0.1);
  const auto refused = run_three_injections(scene(), astray);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "second");
}

}  // namespace
}  // namespace artus
