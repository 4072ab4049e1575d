// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/norms.h"

#include <cmath>
#include <memory>

#include <SQLiteCpp/SQLiteCpp.h>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

std::vector<MetricValue> one_to(int n) {
  std::vector<MetricValue> values;
  for (int i = 1; i <= n; ++i)
    values.push_back({std::to_string(i), "time_s", "needle", "s", static_cast<double>(i)});
  return values;
}

TEST(Norms, MeanSpreadAndPercentilesOfOneToTwenty) {
  auto values = one_to(20);
  values.push_back({"21", "time_s", "needle", "s", std::nullopt});
  const auto norms = compute_norms(values);
  ASSERT_EQ(norms.size(), 1U);
  EXPECT_EQ(norms[0].n, 20);
  EXPECT_DOUBLE_EQ(norms[0].mean, 10.5);
  EXPECT_NEAR(norms[0].sd, std::sqrt(35.0), 1e-12);
  EXPECT_EQ(norms[0].p10, 2);
  EXPECT_EQ(norms[0].p50, 10);
  EXPECT_EQ(norms[0].p90, 18);
}

TEST(Norms, NineAttemptsAreNone) {
  EXPECT_TRUE(compute_norms(one_to(kFewestForNorm - 1)).empty());
  EXPECT_FALSE(compute_norms(one_to(kFewestForNorm)).empty());
}

class NormRecords : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    auto opened = Records::open(in("records.db"));
    ASSERT_TRUE(opened) << opened.error().to_string();
    records_ = std::make_unique<Records>(std::move(*opened));
    ASSERT_TRUE(records_->add_person({"e1", "learner", kExperts}));
    ASSERT_TRUE(records_->add_person({"p1", "learner", "2026"}));
  }
  void note(const std::string& id, double time, const std::string& person = "e1",
            bool aided = false, const std::string& text = "text") {
    AttemptRecord a;
    a.id = id;
    a.person = person;
    a.scenario = "gel";
    a.scenario_hash = text_hash(text);
    a.started = "2026-01-01T00:00:00Z";
    a.ended = "2026-01-01T00:01:00Z";
    a.aided = aided;
    a.folder = "folder-" + id;
    ASSERT_TRUE(records_->begin(a, text));
    const std::vector<Metric> metrics{{"time_s", "needle", "s", time, "d", {"none", 0}}};
    ASSERT_TRUE(records_->finish(a, metrics, {}));
  }
  std::unique_ptr<Records> records_;
};

TEST_F(NormRecords, CountTheGroupsAttemptsWithoutAidsAndNoOthers) {
  for (int i = 1; i <= 10; ++i) note("a" + std::to_string(i), i);
  note("helped", 1000, "e1", true);
  note("learner", 1000, "p1");
  const auto norms = renew_norms(*records_, "gel", kExperts);
  ASSERT_TRUE(norms) << norms.error().to_string();
  ASSERT_EQ(norms->size(), 1U);
  EXPECT_DOUBLE_EQ(norms->front().mean, 5.5);
  const auto kept = records_->norms(text_hash("text"), kExperts);
  ASSERT_EQ(kept->size(), 1U);
  EXPECT_EQ(kept->front().p90, norms->front().p90);
  EXPECT_EQ(kept->front().n, 10);
  ASSERT_TRUE(renew_norms(*records_, "gel", kExperts));
  EXPECT_EQ(records_->norms(text_hash("text"), kExperts)->size(), 1U);
  EXPECT_TRUE(records_->norms(text_hash("other"), kExperts)->empty());
}

TEST_F(NormRecords, TooFewAreRefusedWithTheirNumber) {
  for (int i = 1; i <= 9; ++i) note("a" + std::to_string(i), i);
  const auto norms = renew_norms(*records_, "gel", kExperts);
  ASSERT_FALSE(norms);
  EXPECT_NE(norms.error().message.find("has 9"), std::string::npos) << norms.error().message;
  EXPECT_FALSE(renew_norms(*records_, "no-such", kExperts));
}

TEST_F(NormRecords, RecordsOfTheFirstFormGetTheirTable) {
  note("a1", 1);
  {
    SQLite::Database file(in("records.db"), SQLite::OPEN_READWRITE);
    file.exec("DROP TABLE norm; PRAGMA user_version = 1");
  }
  auto again = Records::open(in("records.db"));
  ASSERT_TRUE(again) << again.error().to_string();
  EXPECT_EQ(again->attempts()->size(), 1U);
  EXPECT_TRUE(again->norms(text_hash("text"), kExperts)->empty());
}

TEST_F(NormRecords, ARaterIsToldWhatIsLeftAndNotWhose) {
  ASSERT_TRUE(records_->add_person({"r1", "rater", ""}));
  ASSERT_TRUE(records_->add_person({"r2", "rater", ""}));
  EXPECT_TRUE(records_->unrated("r1", "OSAUS")->empty());
  EXPECT_FALSE(records_->unrated("p1", "OSAUS"));
  for (int i = 1; i <= 8; ++i) note("a" + std::to_string(i), i);
  const auto ids = [](const std::vector<AttemptRecord>& all) {
    std::string text;
    for (const AttemptRecord& a : all) text += a.id + " ";
    return text;
  };
  const auto left = records_->unrated("r1", "OSAUS");
  ASSERT_EQ(left->size(), 8U);
  EXPECT_TRUE(left->front().person.empty());
  EXPECT_FALSE(left->front().passed);
  EXPECT_EQ(ids(*records_->unrated("r1", "OSAUS")), ids(*left));
  EXPECT_NE(ids(*records_->unrated("r2", "OSAUS")), ids(*left));
  ASSERT_TRUE(records_->rate({left->front().id, "r1", "OSAUS", "overall", 4, true}));
  EXPECT_EQ(records_->unrated("r1", "OSAUS")->size(), 7U);
  EXPECT_EQ(records_->unrated("r1", "other")->size(), 8U);
  EXPECT_EQ(records_->unrated("r2", "OSAUS")->size(), 8U);
}

}  // namespace
}  // namespace artus
