// SPDX-License-Identifier: AGPL-3.0-or-later
// The tool as a user meets it: exit codes, messages, files.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/apps/run_tool.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using test::artus;
using test::kSimple;

using Tool = test::TemporaryFolder;

TEST_F(Tool, WithoutACommandSaysSoAndReturnsTwo) {
  const auto r = artus({});
  EXPECT_EQ(r.exit_code, 2);
  EXPECT_NE((r.out + r.err).find("subcommand"), std::string::npos);
}

TEST_F(Tool, AnUnknownFlagReturnsTwo) {
  EXPECT_EQ(artus({"check", "--no-such-flag"}).exit_code, 2);
}

TEST_F(Tool, AMissingFileReturnsOneAndNamesIt) {
  const auto r = artus({"check", in("absent.stl")});
  EXPECT_EQ(r.exit_code, 1);
  EXPECT_NE(r.err.find("absent.stl"), std::string::npos);
}

TEST_F(Tool, AMalformedPointReturnsTwoBeforeAnythingIsLoaded) {
  const auto r = artus({"needle", "-j", in("absent"), "--entry", "1,2", "--tip", "0,0,0"});
  EXPECT_EQ(r.exit_code, 2);
  EXPECT_NE(r.err.find("--entry"), std::string::npos);
}

TEST_F(Tool, ACompiledFileThatIsCutShortIsRefused) {
  std::filesystem::copy_file(kSimple, in("cut.artus"));
  std::filesystem::resize_file(in("cut.artus"), std::filesystem::file_size(kSimple) / 2);
  const auto r = artus({"needle", "-j", in("cut.artus"), "--entry", "90,0,0", "--tip", "0,0,0"});
  EXPECT_EQ(r.exit_code, 1);
  EXPECT_NE(r.err.find("cut.artus"), std::string::npos);
}

TEST_F(Tool, ChecksABundledSurfaceAsSound) {
  const auto r = artus(
      {"check", artus::test::source_dir().string() + "/meshes/simple-shoulder/surfaces/bone.ply",
       "--json"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const auto report = nlohmann::json::parse(r.out);
  EXPECT_TRUE(report.at("defects").empty());
  EXPECT_GT(report.at("repair").at("volume_cm3").get<double>(), 1);
}

TEST_F(Tool, ChecksAnOpenSheetAsRefusedAndThickensItOnRequest) {
  std::ofstream(in("sheet.off"))
      << "OFF\n4 2 0\n0 0 0\n20 0 0\n20 20 0\n0 20 0\n3 0 1 2\n3 0 2 3\n";
  EXPECT_EQ(artus({"check", in("sheet.off")}).exit_code, 3);
  const auto r = artus({"check", in("sheet.off"), "--thicken", "1", "--repaired", in("plate.ply")});
  EXPECT_EQ(r.exit_code, 0) << r.out << r.err;
  EXPECT_TRUE(std::filesystem::exists(in("plate.ply")));
}

TEST_F(Tool, ANeedleListsContiguousIntervalsAsJson) {
  const auto r = artus({"needle", "-j", kSimple, "--entry", "200,0,0", "--tip", "0,0,0", "--json"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const auto intervals = nlohmann::json::parse(r.out).at("intervals");
  ASSERT_GE(intervals.size(), 2U);
  EXPECT_EQ(intervals.front().at("region"), "outside");
  for (std::size_t i = 1; i < intervals.size(); ++i)
    EXPECT_EQ(intervals[i - 1].at("exit_mm"), intervals[i].at("entry_mm"));
  EXPECT_NEAR(intervals.back().at("exit_mm").get<double>(), 200, 1e-6);
}

TEST_F(Tool, RunsTheMainJobWithAllItsFilesAndEveryClaimHolds) {
  const auto r =
      artus({"run", "three-injections", "-j", kSimple, "--out", in("run"), "--no-video", "--json"});
  ASSERT_EQ(r.exit_code, 0) << r.out << r.err;
  const auto summary = nlohmann::json::parse(r.out);
  EXPECT_TRUE(summary.at("pass").get<bool>());
  EXPECT_TRUE(summary.at("deforms").get<bool>());
  EXPECT_TRUE(summary.at("rigid").at("pass").get<bool>());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "run/rigid/trace.csv"));
  for (const char* file : {"trace.csv", "forces.svg", "summary.json"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "run" / file)) << file;
  ASSERT_GE(summary.at("images").size(), 4U);
  for (const auto& image : summary.at("images"))
    for (const char* kind : {"bmode", "labels"})
      EXPECT_TRUE(std::filesystem::exists(folder_ / "run" / image.at(kind).get<std::string>()));
  const auto sequence = artus({"export", "-j", kSimple, "--poses", in("run/poses.csv"), "--rate",
                               "0.2", "--lines", "16", "--mha", in("run.igs.mha"), "--json"});
  ASSERT_EQ(sequence.exit_code, 0) << sequence.err;
  EXPECT_GE(nlohmann::json::parse(sequence.out).at("frames").get<int>(), 5);
}

TEST_F(Tool, TheMainJobInjectsUnlessItIsDry) {
  const auto wet = artus({"run", "three-injections", "-j", kSimple, "--out", in("wet"),
                          "--no-images", "--rigid", "--json"});
  ASSERT_EQ(wet.exit_code, 0) << wet.out << wet.err;
  const auto injected = nlohmann::json::parse(wet.out).at("injected");
  EXPECT_NEAR(injected.at("given_ml").get<double>(), injected.at("asked_ml").get<double>(), 0.04);
  EXPECT_GT(injected.at("places").at("bursa").at("ml").get<double>(), 1.9);
  const auto dry = artus({"run", "three-injections", "-j", kSimple, "--out", in("dry"),
                          "--no-images", "--rigid", "--json", "--dry"});
  ASSERT_EQ(dry.exit_code, 0) << dry.out << dry.err;
  EXPECT_FALSE(nlohmann::json::parse(dry.out).contains("injected"));
}

TEST_F(Tool, TheMainJobHoldsOnAKneeAndAHip) {
  for (const char* joint : {"knee", "hip"}) {
    const auto r = artus({"run", "three-injections", "-j",
                          artus::test::test_joints().string() + "/" + joint + ".artus", "--out",
                          in(joint), "--no-images", "--rigid", "--json"});
    ASSERT_EQ(r.exit_code, 0) << joint << r.out << r.err;
    EXPECT_TRUE(nlohmann::json::parse(r.out).at("pass").get<bool>()) << joint;
  }
}

TEST_F(Tool, AnInjectionOnTheCommandLineTakesTheJointsPlace) {
  const auto astray = artus({"run", "three-injections", "-j", kSimple, "--out", in("run"),
                             "--no-images", "--entry=-80,0,0"});
  EXPECT_EQ(astray.exit_code, 2);
  const std::string offer = "the skin is at (";
  const auto at = astray.err.find(offer);
  ASSERT_NE(at, std::string::npos) << astray.err;
  std::string entry = astray.err.substr(at + offer.size());
  entry = entry.substr(0, entry.find(')'));
  entry.erase(std::remove(entry.begin(), entry.end(), ' '), entry.end());
  const auto followed = artus({"run", "three-injections", "-j", kSimple, "--out", in("run"),
                               "--no-images", "--rigid", "--entry=" + entry, "--target=-34.1,0,3"});
  EXPECT_EQ(followed.exit_code, 0) << entry << followed.err << followed.out;
}

TEST_F(Tool, ANeedleWithoutFlagsIsTheJointsOwnFromTheSkin) {
  const auto r = artus({"needle", "-j", kSimple, "--json"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const auto intervals = nlohmann::json::parse(r.out).at("intervals");
  ASSERT_GE(intervals.size(), 2U);
  EXPECT_EQ(intervals.front().at("region"), "skin");
  EXPECT_EQ(intervals.front().at("entry_mm").get<double>(), 0);
  EXPECT_EQ(intervals.back().at("region"), "bursa") << "where its target lies";
}

TEST_F(Tool, CheckFitsOnAScreenAndListsTheRestOnRequest) {
  const std::string folder = artus::test::source_dir().string() + "/meshes/shoulder";
  const auto count = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
  };
  const auto brief = artus({"check", folder});
  EXPECT_EQ(brief.exit_code, 0) << brief.err;
  EXPECT_LE(count(brief.out), 24) << brief.out;
  EXPECT_NE(brief.out.find("0 refusals"), std::string::npos) << brief.out;
  EXPECT_GT(count(artus({"check", folder, "--all"}).out), 50);
}

TEST_F(Tool, FindsBundledJointsAndScenariosFromAnyFolder) {
  // The bodies that the other tests have are a user's cache.
  std::filesystem::create_directories(in("home"));
  std::filesystem::create_directory_symlink(artus::test::test_joints() / "cache",
                                            folder_ / "home/artus");
  const auto from_root = [this](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(),
                     {"env", "-C", "/", "XDG_CACHE_HOME=" + in("home"), ARTUS_TOOL});
    return test::run_process(arguments);
  };
  const auto check = from_root({"check", "knee", "--json"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  const auto needle = from_root({"needle", "-j", "simple-shoulder"});
  EXPECT_EQ(needle.exit_code, 0) << needle.err;
  const auto scenario = from_root({"scenario", "check", "sasd-lateral-1", "--no-play"});
  EXPECT_EQ(scenario.exit_code, 0) << scenario.err;
  const auto unknown = from_root({"needle", "-j", "toe"});
  EXPECT_EQ(unknown.exit_code, 1);
}

TEST_F(Tool, FindsBundledJointsBesideAnInstalledProgram) {
  namespace fs = std::filesystem;
  fs::create_directories(in("prefix/bin"));
  fs::create_directories(in("prefix/share/artus/meshes"));
  fs::copy_file(ARTUS_TOOL, in("prefix/bin/artus"));
  fs::copy(test::source_dir() / "meshes/knee", in("prefix/share/artus/meshes/toe"),
           fs::copy_options::recursive);
  const auto check =
      test::run_process({"env", "-C", "/", in("prefix/bin/artus"), "check", "toe", "--json"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
}

TEST_F(Tool, HelloPrintsForcesOfTheCommittedJointAndWritesAPicture) {
  const auto r = test::run_process({"env", "-C", folder_.string(), ARTUS_HELLO});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_GE(std::count(r.out.begin(), r.out.end(), '\n'), 10);
  EXPECT_NE(r.out.find(" N"), std::string::npos) << r.out;
  EXPECT_GT(std::filesystem::file_size(in("hello.png")), 1000U);
}

}  // namespace
}  // namespace artus
