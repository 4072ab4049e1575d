// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/records.h"

#include <csignal>
#include <fstream>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/detail/training/record_export.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

class RecordsTest : public test::TemporaryFolder {
 protected:
  Records open() {
    auto records = Records::open(in("records.db"));
    EXPECT_TRUE(records) << (records ? "" : records.error().to_string());
    return std::move(*records);
  }
  static AttemptRecord attempt(const std::string& id) {
    AttemptRecord a;
    a.id = id;
    a.person = "p1";
    a.scenario = "gel";
    a.scenario_hash = text_hash("text");
    a.started = "2026-01-01T00:00:00Z";
    a.ended = "2026-01-01T00:01:00Z";
    a.duration = 60;
    a.passed = true;
    a.score = 80;
    return a;
  }
  static std::vector<Metric> metrics() {
    return {{"distance_mm", "needle", "mm", 1.0 / 3, "d", {"none", 0}},
            {"tip_seen", "both", "-", std::nullopt, "s", {"none", 0}}};
  }
};

TEST_F(RecordsTest, WhatIsFinishedReadsBackToTheSameBits) {
  Records records = open();
  ASSERT_TRUE(records.add_person({"p1", "learner", "c"}));
  ASSERT_TRUE(records.begin(attempt("a1"), "text"));
  EXPECT_TRUE(records.attempts()->front().ended.empty());
  const std::vector<AttemptEvent> events{{1.5, "bone", "humerus", 2, "on <b>bone</b>"}};
  ASSERT_TRUE(records.finish(attempt("a1"), metrics(), events));
  Records again = open();
  const auto attempts = again.attempts({"p1", "c", "gel"});
  ASSERT_TRUE(attempts);
  ASSERT_EQ(attempts->size(), 1U);
  EXPECT_TRUE(attempts->front().passed);
  const auto values = again.metrics();
  ASSERT_EQ(values->size(), 2U);
  EXPECT_EQ(*values->front().value, 1.0 / 3);
  EXPECT_FALSE(values->back().value);
  EXPECT_EQ(again.events("a1")->front().text, "on <b>bone</b>");
  EXPECT_TRUE(again.attempts({"nobody", "", ""})->empty());
}

TEST_F(RecordsTest, NobodyUnknownHasAttemptsOrRates) {
  Records records = open();
  EXPECT_FALSE(records.begin(attempt("a1"), "text"));
  ASSERT_TRUE(records.add_person({"p1", "learner", ""}));
  ASSERT_TRUE(records.begin(attempt("a1"), "text"));
  EXPECT_FALSE(records.begin(attempt("a1"), "text"));
  EXPECT_FALSE(records.rate({"a1", "p1", "OSAUS", "overall", 4, true}));
  ASSERT_TRUE(records.add_person({"r1", "rater", ""}));
  EXPECT_TRUE(records.rate({"a1", "r1", "OSAUS", "overall", 4, true}));
  EXPECT_FALSE(records.rate({"a1", "r1", "OSAUS", "overall", 7, true})) << "a form of 1 to 5";
  const auto nobody = records.rate({"a1", "r9", "OSAUS", "overall", 4, true});
  ASSERT_FALSE(nobody);
  EXPECT_NE(nobody.error().message.find("learners add --role rater --person r9"),
            std::string::npos);
  EXPECT_EQ(records.ratings("a1")->size(), 1U);
  EXPECT_FALSE(records.finish(attempt("a2"), {}, {}));
  EXPECT_FALSE(records.add_person({"p2", "king", ""}));
}

TEST_F(RecordsTest, ForgettingLeavesThatThereWasAnAttempt) {
  Records records = open();
  ASSERT_TRUE(records.add_person({"p1", "learner", ""}));
  ASSERT_TRUE(records.begin(attempt("a1"), "text"));
  ASSERT_TRUE(records.finish(attempt("a1"), metrics(), {}));
  ASSERT_TRUE(records.forget("p1"));
  EXPECT_FALSE(records.forget("p1"));
  EXPECT_TRUE(records.persons()->empty());
  EXPECT_EQ(records.attempts()->size(), 1U);
  EXPECT_TRUE(records.attempts()->front().person.empty());
  EXPECT_TRUE(records.metrics()->empty());
}

TEST_F(RecordsTest, WhatIsNoDatabaseOrOfALaterFormIsRefused) {
  std::ofstream(in("text.db")) << "this is a text that is long enough to be no database at all";
  const auto text = Records::open(in("text.db"));
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::corrupt);
  {
    SQLite::Database later(in("later.db"), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    later.exec("PRAGMA user_version = 99");
  }
  const auto later = Records::open(in("later.db"));
  ASSERT_FALSE(later);
  EXPECT_EQ(later.error().code, ErrorCode::unsupported);
  EXPECT_FALSE(Records::open("/proc/records.db"));
}

TEST_F(RecordsTest, ARefusalSaysWhatWhereAndWhatToDo) {
  Records records = open();
  SQLite::Database other(in("records.db"), SQLite::OPEN_READWRITE);
  other.exec("DROP TABLE person");
  const auto persons = records.persons();
  ASSERT_FALSE(persons);
  EXPECT_EQ(persons.error().where, in("records.db"));
  EXPECT_NE(persons.error().message.find("no such table: person"), std::string::npos);
  const auto added = records.add_person({"p1", "learner", ""});
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::unreadable);
  const auto nowhere = Records::open("/proc/records.db");
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().where, "/proc/records.db");
  EXPECT_NE(nowhere.error().message.find("may be written"), std::string::npos);
}

TEST_F(RecordsTest, TwoProgramsWriteOneFile) {
  ASSERT_TRUE(open().add_person({"p1", "learner", ""}));
  const auto write = [this](const std::string& prefix) {
    Records records = open();
    for (int i = 0; i < 25; ++i) {
      const AttemptRecord a = attempt(prefix + std::to_string(i));
      EXPECT_TRUE(records.begin(a, "text"));
      EXPECT_TRUE(records.finish(a, metrics(), {}));
    }
  };
  std::thread one(write, "a");
  std::thread two(write, "b");
  one.join();
  two.join();
  EXPECT_EQ(open().attempts()->size(), 50U);
}

TEST_F(RecordsTest, AKilledProgramLosesNothingThatWasFinished) {
  ASSERT_TRUE(open().add_person({"p1", "learner", ""}));
  std::size_t promised = 0;
  for (int kill_after = 0; kill_after < 12; ++kill_after) {
    int told[2];
    ASSERT_EQ(pipe(told), 0);
    const pid_t child = fork();
    if (child == 0) {
      auto records = Records::open(in("records.db"));
      for (int i = 0; records && i < 1000; ++i) {
        const AttemptRecord a = attempt(std::to_string(kill_after) + "-" + std::to_string(i));
        if (!records->begin(a, "text") || !records->finish(a, metrics(), {})) break;
        if (write(told[1], "x", 1) != 1) break;
      }
      _exit(0);
    }
    usleep(static_cast<useconds_t>(3000 + 4700 * kill_after));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(told[1]);
    char byte = 0;
    while (read(told[0], &byte, 1) == 1) ++promised;
    close(told[0]);
  }
  Records records = open();
  std::size_t finished = 0;
  const auto attempts = records.attempts();
  ASSERT_TRUE(attempts);
  for (const AttemptRecord& a : *attempts) finished += a.ended.empty() ? 0 : 1;
  EXPECT_GE(finished, promised);
  SQLite::Database file(in("records.db"));
  EXPECT_EQ(file.execAndGet("PRAGMA integrity_check").getString(), "ok");
}

TEST_F(RecordsTest, WhatRatersSaidIsExportedBesideTheNumbers) {
  Records records = open();
  ASSERT_TRUE(records.add_person({"p1", "learner", ""}));
  ASSERT_TRUE(records.add_person({"r1", "rater", ""}));
  ASSERT_TRUE(records.begin(attempt("a1"), "text"));
  ASSERT_TRUE(records.finish(attempt("a1"), metrics(), {}));
  ASSERT_TRUE(records.begin(attempt("a2"), "text"));
  ASSERT_TRUE(records.rate({"a1", "r1", "OSAUS", "overall", 4, true}));
  ASSERT_TRUE(records.rate({"a1", "r1", "OSAUS", "overall", 3, false}));
  ASSERT_TRUE(records.comment("a1", "r1", 12.5, "looked <away>"));
  const auto json = export_json(records, {});
  ASSERT_TRUE(json);
  ASSERT_EQ(json->size(), 2U);
  const auto& rated = (*json)[0];
  ASSERT_EQ(rated["ratings"].size(), 2U) << "given twice, kept twice";
  EXPECT_EQ(rated["ratings"][0]["value"], 4);
  EXPECT_EQ(rated["ratings"][1]["blinded"], false);
  ASSERT_EQ(rated["comments"].size(), 1U);
  EXPECT_EQ(rated["comments"][0]["text"], "looked <away>");
  EXPECT_EQ(rated["comments"][0]["time_s"], 12.5);
  EXPECT_TRUE((*json)[1]["ratings"].empty());
  ASSERT_TRUE(records.forget("p1"));
  EXPECT_TRUE((*export_json(records, {}))[0]["comments"].empty());
}

TEST_F(RecordsTest, ExportsSayTheSame) {
  Records records = open();
  ASSERT_TRUE(records.add_person({"p1", "learner", ""}));
  ASSERT_TRUE(records.begin(attempt("a1"), "text"));
  ASSERT_TRUE(records.finish(attempt("a1"), metrics(), {}));
  ASSERT_TRUE(records.begin(attempt("a2"), "text"));  // unfinished
  const auto json = export_json(records, {});
  ASSERT_TRUE(json);
  EXPECT_EQ(json->size(), 2U);
  EXPECT_EQ((*json)[0]["metrics"][0]["value"].get<double>(), 1.0 / 3);
  EXPECT_NE(export_csv(records, {})->find("0.33333333333333331"), std::string::npos);
  EXPECT_NE(export_tsv(records, {})->find("distance_mm\tneedle\tmm\t0.3333"), std::string::npos);
  const auto xapi = export_xapi(records, {}, "https://school.example");
  ASSERT_TRUE(xapi);
  ASSERT_EQ(xapi->size(), 1U);
  const auto& statement = xapi->front();
  EXPECT_EQ(statement["verb"]["id"], "http://adlnet.gov/expapi/verbs/passed");
  EXPECT_EQ(statement["actor"]["account"]["name"], "p1");
  EXPECT_EQ(statement["result"]["score"]["scaled"], 0.8);
  EXPECT_EQ(statement["result"]["duration"], "PT60S");
  EXPECT_THAT(
      statement["id"].get<std::string>(),
      testing::MatchesRegex("[0-9a-f]{8}-[0-9a-f]{4}-5[0-9a-f]{3}-a[0-9a-f]{3}-[0-9a-f]{12}"));
  EXPECT_EQ(statement["id"], (*export_xapi(records, {}, "https://school.example"))[0]["id"]);
  EXPECT_EQ(statement["result"]["success"], true);
}

}  // namespace
}  // namespace artus
