// SPDX-License-Identifier: AGPL-3.0-or-later
// The list of commands: groups, help, names of before.
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/apps/options/old_names.h"
#include "tests/apps/run_tool.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using test::artus;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

using Commands = test::TemporaryFolder;

TEST(Program, TellsAFailureThatNothingCaughtAndReturnsOne) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_program([]() -> ExitCode { throw std::runtime_error("no paper left"); }), 1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "artus: no paper left\n");
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_program([]() -> ExitCode { throw 7; }), 1);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("unknown failure"));
  EXPECT_EQ(run_program([] { return ExitCode::defects; }), 3);
}

TEST(Program, ReturnsWhatTheCommandDidOrThatTheLineIsWrong) {
  const auto run = [](std::vector<const char*> line) {
    ExitCode code = ExitCode::ok;
    Command app("a program");
    Command* fails = add_command(app, "fails", "fails", "");
    on_run(fails, code, []() -> Result<void> { return fail(ErrorCode::not_found, "gone"); });
    Command* works = add_command(app, "works", "works", "");
    on_run(works, code, []() -> Result<void> { return {}; });
    line.insert(line.begin(), "program");
    testing::internal::CaptureStderr();
    code = run_commands(app, static_cast<int>(line.size()), line.data(), code);
    return std::pair(code, testing::internal::GetCapturedStderr());
  };
  EXPECT_EQ(run({"works"}).first, ExitCode::ok);
  EXPECT_EQ(run({"fails"}).first, ExitCode::failed);
  EXPECT_THAT(run({"fails"}).second, HasSubstr("gone"));
  EXPECT_EQ(run({"works", "--faster"}).first, ExitCode::usage);
}

/// A command that --help lists, "check" or "image labels", and what its own --help gives.
struct Listed {
  std::string name;
  test::ProcessResult help;
};

/// All that --help lists, with those of commands that have some; each is started once.
std::vector<Listed> listed_commands(const std::string& help_of_all) {
  const auto names_in = [](const std::string& help) {
    std::vector<std::string> names;
    std::istringstream lines(help);
    bool in_list = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("For ", 0) == 0 || line == "Subcommands:") in_list = true;
      if (line.empty()) in_list = false;
      if (in_list && line.rfind("  ", 0) == 0 && line[2] != ' ')
        names.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
    return names;
  };
  std::vector<Listed> all;
  for (const std::string& name : names_in(help_of_all)) {
    all.push_back({name, artus({name, "--help"})});
    for (const std::string& own : names_in(all.back().help.out))
      all.push_back({name + " " + own, artus({name, own, "--help"})});
  }
  return all;
}

void expect_examples_once(const Listed& command) {
  EXPECT_EQ(command.help.exit_code, 0) << command.name;
  EXPECT_EQ(command.help.err, "") << command.name;
  const std::string& text = command.help.out;
  for (const char* once : {"Usage:", "Examples:"}) {
    const auto at = text.find(once);
    ASSERT_NE(at, std::string::npos) << command.name << ' ' << once;
    EXPECT_EQ(text.find(once, at + 1), std::string::npos) << command.name << ' ' << once;
  }
  EXPECT_THAT(text, HasSubstr("\n  artus " + command.name));
}

TEST_F(Commands, AreAboutTwentyInGroupsByWhoUsesThemEachWithExamplesOnce) {
  const std::string help = artus({"--help"}).out;
  for (const char* group : {"For anatomists:", "For trainees and teachers:", "For researchers:",
                            "For haptics labs:", "For developers:"})
    EXPECT_THAT(help, HasSubstr(group));
  const auto all = listed_commands(help);
  std::vector<std::string> names;
  for (const Listed& one : all) {
    names.push_back(one.name);
    expect_examples_once(one);
  }
  const auto alone = std::count_if(names.begin(), names.end(), [](const std::string& name) {
    return name.find(' ') == std::string::npos;
  });
  EXPECT_GE(alone, 20);
  EXPECT_LE(alone, 25) << "merge what is one thing";
  for (const char* one : {"image labels", "sweep merge", "learners rate", "serve monitor"})
    EXPECT_THAT(names, testing::Contains(one));
}

TEST_F(Commands, FlagsOfACommandAreNotAskedOfItsOwnCommands) {
  const auto merge = artus({"sweep", "merge", in("none")});
  EXPECT_THAT(merge.err, Not(HasSubstr("--joint")));
  const auto sweep = artus({"sweep"});
  EXPECT_EQ(sweep.exit_code, 2);
  EXPECT_THAT(sweep.err, HasSubstr("--joint"));
}

TEST_F(Commands, WhatThereIsNotIsToldByName) {
  const auto told = [](const std::vector<std::string>& line) {
    const auto r = artus(line);
    EXPECT_NE(r.exit_code, 0) << line.front();
    return r.err;
  };
  EXPECT_THAT(told({"imgae", "-j", "shoulder"}), HasSubstr("no command 'imgae'"));
  EXPECT_THAT(told({"imgae"}), HasSubstr("'image'"));
  EXPECT_THAT(told({"needle", "-j", "jaw"}), HasSubstr("jaw: there is no such joint"));
  EXPECT_THAT(told({"serve", "-j", test::kSimple, "--rigid", "--input", "banana"}),
              HasSubstr("'banana' is neither shared-memory"));
  EXPECT_THAT(told({"replay", in("none.rec")}), HasSubstr("name the joint, or the scenario"));
  EXPECT_THAT(told({"replay", in("none.rec"), "--scenario", "gel-fnd"}), HasSubstr("gel-find"));
  EXPECT_THAT(told({"learners", "show", "--records", in("none.db")}), HasSubstr("none.db"));
  EXPECT_FALSE(std::filesystem::exists(in("none.db"))) << "looking makes nothing";
}

TEST_F(Commands, AnOldNameWorksAndSaysItsNewOne) {
  const auto old = artus({"phantom", "cyst", "--out", in("old"), "--lines", "16", "--json"});
  EXPECT_EQ(old.exit_code, 0) << old.err;
  EXPECT_EQ(old.err,
            "artus: 'artus phantom' is 'artus image phantom' now; the old name goes with "
            "the next version\n");
  const auto now =
      artus({"image", "phantom", "cyst", "--out", in("now"), "--lines", "16", "--json"});
  EXPECT_EQ(now.err, "");
  EXPECT_EQ(old.out, now.out);
}

TEST_F(Commands, OldNamesKeepTheirDefaults) {
  const auto renamed = [](const std::vector<std::string>& line) {
    return rename_command(line)->arguments;
  };
  EXPECT_THAT(renamed({"loop", "--seconds=3", "--device", "delta"}),
              ElementsAre("serve", "--no-images", "--seconds=3", "--device", "delta", "--input",
                          "injection", "--speed-mm-s", "15"));
  EXPECT_THAT(renamed({"experiment", "rates", "--tissue"}),
              ElementsAre("validate", "needle", "probe", "rates", "--tissue", "--rigid"));
  EXPECT_THAT(renamed({"sweep-merge", "a"}), ElementsAre("sweep", "merge", "a"));
  EXPECT_FALSE(rename_command({"sweep", "merge", "a"}));
  EXPECT_FALSE(rename_command({}));
}

}  // namespace
}  // namespace artus
