// SPDX-License-Identifier: AGPL-3.0-or-later
// The list of commands: groups, help, names of before.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

/// "check", "image labels", ...: all that --help lists, with those of commands that have some.
std::vector<std::string> listed_commands() {
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
  std::vector<std::string> all;
  for (const std::string& name : names_in(artus({"--help"}).out)) {
    all.push_back(name);
    for (const std::string& own : names_in(artus({name, "--help"}).out))
      all.push_back(name + " " + own);
  }
  return all;
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

TEST_F(Commands, AreAboutTwentyInGroupsByWhoUsesThem) {
  const std::string help = artus({"--help"}).out;
  for (const char* group : {"For anatomists:", "For trainees and teachers:", "For researchers:",
                            "For haptics labs:", "For developers:"})
    EXPECT_THAT(help, HasSubstr(group));
  const auto all = listed_commands();
  const auto alone = std::count_if(all.begin(), all.end(), [](const std::string& name) {
    return name.find(' ') == std::string::npos;
  });
  EXPECT_GE(alone, 20);
  EXPECT_LE(alone, 24) << "merge what is one thing";
  for (const char* one : {"image labels", "sweep merge", "learners rate", "serve monitor"})
    EXPECT_THAT(all, testing::Contains(one));
}

TEST_F(Commands, EachHasHelpWithExamplesOnce) {
  for (const std::string& name : listed_commands()) {
    auto line = words_of(name);
    line.emplace_back("--help");
    const auto r = artus(line);
    EXPECT_EQ(r.exit_code, 0) << name;
    EXPECT_EQ(r.err, "") << name;
    for (const std::string& once : {std::string("Usage:"), std::string("Examples:")}) {
      const auto at = r.out.find(once);
      ASSERT_NE(at, std::string::npos) << name << ' ' << once;
      EXPECT_EQ(r.out.find(once, at + 1), std::string::npos) << name << ' ' << once;
    }
    EXPECT_THAT(r.out, HasSubstr("\n  artus " + name)) << name;
  }
}

TEST_F(Commands, FlagsOfACommandAreNotAskedOfItsOwnCommands) {
  const auto merge = artus({"sweep", "merge", in("none")});
  EXPECT_THAT(merge.err, Not(HasSubstr("--joint")));
  const auto sweep = artus({"sweep"});
  EXPECT_EQ(sweep.exit_code, 2);
  EXPECT_THAT(sweep.err, HasSubstr("--joint"));
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
