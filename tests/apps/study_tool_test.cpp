// SPDX-License-Identifier: AGPL-3.0-or-later
// What a school reads of its records: reliability, pass marks, and where each learner stands.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/core/text_file.h"
#include "artus/detail/training/records.h"
#include "artus/detail/training/scenario.h"
#include "tests/apps/run_tool.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

class Study : public test::TemporaryFolder {
 protected:
  /// Two experts with full scores and two learners who are 4 mm off, each in two scenarios.
  void fill() const {
    auto records = Records::open(file());
    ASSERT_TRUE(records);
    int n = 0;
    for (const char* person : {"e1", "e2", "n1", "n2"}) {
      const bool expert = person[0] == 'e';
      ASSERT_TRUE(records->add_person({person, "learner", expert ? "experts" : "2026"}));
      for (const char* scenario : {"gel-find", "gel-align"}) {
        AttemptRecord a;
        a.id = "a" + std::to_string(++n);
        a.person = person;
        a.scenario = scenario;
        a.scenario_hash = text_hash(find_scenario(scenario)->text);
        a.started = "2026-01-01T00:00:0" + std::to_string(n) + "Z";
        ASSERT_TRUE(records->begin(a, find_scenario(scenario)->text));
        a.ended = a.started;
        a.passed = expert;
        a.score = expert ? 100 : 30 + n;
        const std::vector<Metric> metrics{
            {"distance_mm", "needle", "mm", expert ? 1.0 : 9.0, "", {}},
            {"unseen_advances", "both", "count", 1.0, "", {}},
            {"plane_offset_p90_mm", "both", "mm", 1.0, "", {}},
            {"withdrawn", "needle", "-", 1.0, "", {}},
            {"done_s", "needle", "s", 20.0, "", {}},
            {"entry_offset_mm", "needle", "mm", 1.0, "", {}},
            {"entry_angle_deg", "both", "deg", 30.0, "", {}}};
        ASSERT_TRUE(records->finish(a, metrics, {}));
      }
    }
  }
  [[nodiscard]] std::string file() const { return (folder_ / "school.db").string(); }
};

TEST_F(Study, PassMarksPartTheGroupsAndReliabilityIsOfWhoDidBoth) {
  fill();
  const auto plot = (folder_ / "cuts.svg").string();
  const auto result =
      test::artus({"learners", "study", "--records", file(), "--plot", plot, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json["cuts"].size(), 2U);
  EXPECT_EQ(json["cuts"][0]["experts_fail"], 0);
  EXPECT_EQ(json["cuts"][0]["others_pass"], 0);
  EXPECT_GT(json["cuts"][0]["cut"].get<double>(), 38);
  EXPECT_LT(json["cuts"][0]["cut"].get<double>(), 100);
  const auto& scores = json["reliability"][0];
  EXPECT_EQ(scores["persons"], 4);
  EXPECT_EQ(scores["conditions"], 2);
  EXPECT_GT(scores["icc_single"].get<double>(), 0.95);
  EXPECT_TRUE(std::filesystem::exists(plot));
}

TEST_F(Study, RatersAreComparedOverWhatAllOfThemRated) {
  fill();
  {
    auto records = Records::open(file());
    for (const char* rater : {"r1", "r2"}) {
      ASSERT_TRUE(records->add_person({rater, "rater", ""}));
      for (int n = 1; n <= 8; ++n)
        ASSERT_TRUE(
            records->rate({"a" + std::to_string(n), rater, "OSAUS", "overall", 1.0 + n % 4, true}));
    }
  }
  const auto result = test::artus({"learners", "study", "--records", file(), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  bool found = false;
  const auto json = nlohmann::json::parse(result.out);
  for (const auto& r : json["reliability"]) {
    if (r["of"] != "OSAUS, overall" || r["over"] != "raters") continue;
    found = true;
    EXPECT_NEAR(r["icc_single"].get<double>(), 1, 1e-9);
  }
  EXPECT_TRUE(found) << result.out;
}

TEST_F(Study, TheCohortPageSaysWhatEachOneIsStuckOnAndKeepsTheNumbersBehindAClick) {
  fill();
  const auto page = (folder_ / "c.html").string();
  const auto result =
      test::artus({"learners", "report", "--records", file(), "--cohort", "2026", "--out", page});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto text = read_bytes(page);
  ASSERT_TRUE(text);
  const std::size_t stuck = text->find("tip from the target");
  const std::size_t details = text->find("<details>");
  ASSERT_NE(stuck, std::string::npos);
  ASSERT_NE(details, std::string::npos);
  EXPECT_LT(stuck, details);
  EXPECT_EQ(text->find("plane_offset_p90_mm (both"), text->find("plane_offset_p90_mm"))
      << "raw names stand behind the click alone";
  EXPECT_GT(text->find("plane_offset_p90_mm"), details);
}

}  // namespace
}  // namespace artus
