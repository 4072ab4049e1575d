// SPDX-License-Identifier: AGPL-3.0-or-later
// Whatever fails, the trainer's window stays and says so: each failure is made for real, seen as a
// page, mended, and tried again.
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>

#include <gtest/gtest.h>

#include "artus/detail/trainer/bodies.h"
#include "artus/detail/trainer/trouble.h"
#include "artus/detail/training/player.h"
#include "artus/detail/training/records.h"
#include "tests/apps/run_tool.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

class TrainTrouble : public test::TemporaryFolder {
 protected:
  /// `artus train` under a virtual display; `before` is said to the shell first.
  [[nodiscard]] test::ProcessResult train(const std::string& before, const std::string& more,
                                          const std::string& script) const {
    std::ofstream(folder_ / "steps.script") << script;
    const std::string command = before + "; timeout 120 " + ARTUS_TOOL + " train " + more +
                                " --script " + (folder_ / "steps.script").string() +
                                " --language en --width 900 --height 560; echo exit $?";
    return test::run_process({"xvfb-run", "-a", "sh", "-c", command});
  }
  [[nodiscard]] std::string records() const { return (folder_ / "records.db").string(); }
  [[nodiscard]] std::string shot(const std::string& name) const {
    return "wait 0.5\nscreenshot " + (folder_ / name).string() + "\n";
  }
  [[nodiscard]] bool wait_for(const std::string& name) const {
    for (int i = 0; i < 600 && !std::filesystem::exists(folder_ / name); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return std::filesystem::exists(folder_ / name);
  }
};

const std::string kToTheBriefing = "page who\nkey ENTER\npage pseudonym\nkey ENTER\n";
const std::string kAttempt =
    "page briefing\nkey ENTER\npage attempt\nawait picture 20\nkey N\nscroll 81\n"
    "await inside 20\nwait 1\nscroll -90\nawait outside 20\nkey F10\n";

TEST_F(TrainTrouble, RecordsThatDoNotOpenAreAPageUntilTheyDo) {
  if (!test::has_virtual_display()) GTEST_SKIP() << "xvfb-run is not installed";
  std::ofstream(folder_ / "place") << "a file where a folder should be";
  std::thread mends([this] {
    if (wait_for("trouble.png")) std::filesystem::remove(folder_ / "place");
  });
  const auto result = train(
      "true", "--records " + (folder_ / "place/records.db").string(),
      "page trouble\n" + shot("trouble.png") + "wait 3\nkey ENTER\npage who\n" + shot("who.png"));
  mends.join();
  EXPECT_NE(result.out.find("exit 0"), std::string::npos) << result.out << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "who.png"));
}

TEST_F(TrainTrouble, WhoLeavesTheTroublePageGetsTheFailureAsTheProgramsOwn) {
  if (!test::has_virtual_display()) GTEST_SKIP() << "xvfb-run is not installed";
  const auto result =
      train("true", "--records /dev/null/records.db", "page trouble\nkey DOWN\nkey ENTER\n");
  EXPECT_NE(result.out.find("exit 1"), std::string::npos) << result.out << result.err;
  EXPECT_NE(result.err.find("records"), std::string::npos) << result.err;
}

TEST_F(TrainTrouble, ABodyThatIsNotFoundIsAPageAndAnotherTaskGoesOn) {
  if (!test::has_virtual_display()) GTEST_SKIP() << "xvfb-run is not installed";
  const auto result =
      train("true", "ac-1 --joint /nowhere/shoulder --records " + records(),
            kToTheBriefing + "page briefing\nkey DOWN\nkey DOWN\nkey DOWN\nkey DOWN\nkey ENTER\n" +
                "page trouble\n" + shot("trouble.png") + "key DOWN\nkey ENTER\npage what\n");
  EXPECT_NE(result.out.find("exit 0"), std::string::npos) << result.out << result.err;
}

TEST_F(TrainTrouble, AnAttemptIsKeptUntilAnotherProgramLetsTheRecordsGo) {
  if (!test::has_virtual_display()) GTEST_SKIP() << "xvfb-run is not installed";
  std::thread holds([this] {
    if (!wait_for("begun.png")) return;
    SQLite::Database db(records(), SQLite::OPEN_READWRITE, 5000);
    SQLite::Transaction other(db, SQLite::TransactionBehavior::EXCLUSIVE);
    std::ofstream(folder_ / "held") << "held";
    EXPECT_TRUE(wait_for("trouble.png"));
  });
  std::string attempt = kAttempt;
  attempt.insert(attempt.find("key N"), shot("begun.png") + "wait 2\n");
  const auto result = train("true", "gel-find --records " + records(),
                            kToTheBriefing + attempt + "page trouble\n" + shot("trouble.png") +
                                "wait 2\nkey ENTER\npage end\n" + shot("end.png"));
  holds.join();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "held"));
  EXPECT_NE(result.out.find("exit 0"), std::string::npos) << result.out << result.err;
  auto file = Records::open(records());
  ASSERT_TRUE(file);
  const auto attempts = file->attempts();
  ASSERT_TRUE(attempts);
  ASSERT_EQ(attempts->size(), 1U);
  EXPECT_FALSE(attempts->front().ended.empty()) << "stored when it could be";
}

TEST_F(TrainTrouble, AFolderThatCannotBeWrittenAfterTheAttemptLosesNothing) {
  if (!test::has_virtual_display()) GTEST_SKIP() << "xvfb-run is not installed";
  const auto attempts = folder_ / "attempts";
  std::filesystem::path moved;
  std::thread breaks([&] {
    if (!wait_for("begun.png")) return;
    for (const auto& one : std::filesystem::directory_iterator(attempts)) moved = one.path();
    std::filesystem::create_directory(moved / "attempt.json");  // no file can be written there
    if (wait_for("trouble.png")) std::filesystem::remove(moved / "attempt.json");
  });
  std::string attempt = kAttempt;
  attempt.insert(attempt.find("key N"), shot("begun.png") + "wait 1\n");
  const auto result = train("true", "gel-find --records " + records(),
                            kToTheBriefing + attempt + "page trouble\n" + shot("trouble.png") +
                                "wait 2\nkey ENTER\npage end\n" + shot("end.png"));
  breaks.join();
  EXPECT_NE(result.out.find("exit 0"), std::string::npos) << result.out << result.err;
  EXPECT_TRUE(std::filesystem::is_regular_file(moved / "attempt.json"));
  EXPECT_TRUE(std::filesystem::exists(moved / "report.html"));
}

TEST(Trouble, EachFailureHasItsRemedy) {
  const auto remedy = [](ErrorCode code, const char* message) {
    return std::string(remedy_of({code, message, ""}));
  };
  EXPECT_NE(remedy(ErrorCode::unreadable,
                   "the records: database is locked; another program is "
                   "using it, try again")
                .find("other program"),
            std::string::npos);
  EXPECT_NE(remedy(ErrorCode::unreadable, "No space left on device").find("room"),
            std::string::npos);
  EXPECT_NE(remedy(ErrorCode::unreadable, "attempt to write a readonly database").find("Allow"),
            std::string::npos);
  EXPECT_NE(remedy(ErrorCode::not_found, "there is no such file").find("missing"),
            std::string::npos);
  const Page page = make_trouble_page({ErrorCode::failed, "it broke", "here"}, "All is well.", true,
                                      Language::french);
  EXPECT_EQ(page.choices.size(), 3U);
  EXPECT_EQ(page.name, "trouble");
}

TEST(Trouble, AReportThatIsGoneIsToldAndNotOpened) {
  const auto opened = open_file("/nowhere/report.html");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::not_found);
}

TEST(TrainBodies, WhatIsGivenUpEndsAtItsNextStepAndIsMadeAnewWhenAskedFor) {
  using namespace std::chrono_literals;
  const auto gel = find_scenario("gel-find");
  const auto other = find_scenario("gel-look");
  ASSERT_TRUE(gel && other);
  std::atomic<int> begun{0};
  std::atomic<bool> slow{true};
  TrainBodies bodies(
      "", [&](const Scenario& scenario, const std::filesystem::path&, const Progress& progress) {
        ++begun;
        for (int i = 0; slow && i < 3000; ++i) {
          progress("filling with tetrahedra", i / 3000.0);
          std::this_thread::sleep_for(10ms);
        }
        return make_gel_scene(*scenario.gel);
      });
  const auto until = [&](auto done) {
    for (int i = 0; i < 2000 && !done(); ++i) std::this_thread::sleep_for(10ms);
    return done();
  };
  bodies.prepare(*gel);
  EXPECT_TRUE(until([&] { return bodies.progress().second > 0.001; }));
  EXPECT_EQ(bodies.progress().first, "filling with tetrahedra");
  EXPECT_FALSE(bodies.ready(*gel));
  const auto before = std::chrono::steady_clock::now();
  bodies.prepare(*other);  // another is wanted: the first is given up
  EXPECT_TRUE(until([&] {
    bodies.prepare(*other);
    return begun == 2;
  }));
  EXPECT_LT(std::chrono::steady_clock::now() - before, 5s);
  slow = false;
  EXPECT_TRUE(until([&] {
    bodies.prepare(*other);
    return bodies.ready(*other);
  }));
  EXPECT_FALSE(bodies.ready(*gel));
  EXPECT_TRUE(bodies.scene(*other));
  EXPECT_TRUE(until([&] {
    bodies.prepare(*gel);
    return bodies.ready(*gel);
  }));
}

}  // namespace
}  // namespace artus
