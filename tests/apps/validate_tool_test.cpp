// SPDX-License-Identifier: AGPL-3.0-or-later
// `artus validate`, the program that measures what artus claims, as a user meets it.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/apps/run_tool.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using test::artus;
using testing::HasSubstr;

using Validate = test::TemporaryFolder;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(Validate, ListsSetsAndGatesWithoutMeasuringAny) {
  const auto r = artus({"validate", "--list"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  for (const char* part : {"needle: ", "wall-move", "echo: ", "tendon", "soft: ", "joint-pressed",
                           "(with -j)", "injection: ", "probe: ", "probe-isp"})
    EXPECT_THAT(r.out, HasSubstr(part));
}

TEST_F(Validate, AReportHasValueBoundAndVerdict) {
  const auto r = artus({"validate", "echo", "--only", "needle-angle", "--only", "enhancement",
                        "--out", in("g"), "--results", in("r"), "--json"});
  ASSERT_EQ(r.exit_code, 0) << r.out << r.err;
  const auto report = nlohmann::json::parse(r.out);
  EXPECT_TRUE(report.at("pass").get<bool>());
  for (const auto& claim : report.at("gates").at("needle-angle").at("claims"))
    for (const char* key : {"claim", "value", "bound", "pass"}) EXPECT_TRUE(claim.contains(key));
  for (const char* file : {"report.md", "gates.json", "pictures/needle-angle.svg",
                           "pictures/needle-30-image.png", "pictures/cyst-image.png"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "g" / file)) << file;
  const std::string page = text_of(folder_ / "r/echo.md");
  for (const char* part : {"| commit | ", "`artus validate echo --only needle-angle",
                           "| claim | "
                           "kind | measured | bound | holds |",
                           "## enhancement"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST_F(Validate, WhatIsWrongWithTheLineIsTold) {
  const auto refused = [&](std::vector<std::string> line, const char* said) {
    line.insert(line.begin(), "validate");
    const auto r = artus(line);
    EXPECT_EQ(r.exit_code, 2) << said << r.out;
    EXPECT_THAT(r.err, HasSubstr(said));
  };
  refused({"echo", "--only", "no-such", "--out", in("g")}, "needle-rings");
  refused({"softt", "--out", in("g")}, "softt");
  refused({"soft", "--only", "joint-pressed", "--out", in("g")}, "needs -j");
  refused({"soft"}, "--out");
  refused({"echo", "--reference", "stats.tsv", "--out", in("g")}, "--joint");
  refused({"needle", "wall-move", "--all", "--out", in("g")}, "--all");
  for (const char* value : {"nan", "-1", "1.5", "99999999999999999999", ""})
    refused({"needle", "wall-move", "--out", in("g"), "--seed", value}, "--seed");
}

TEST_F(Validate, AnExperimentTakesTheLawsItDoesNotFix) {
  const auto taken = artus({"validate", "needle", "--only", "wall-move", "--rigid", "--cutting",
                            "layer 1=spring", "--out", in("e"), "--json"});
  EXPECT_EQ(taken.exit_code, 1) << taken.err;  // the published claims are the wall's
  EXPECT_FALSE(nlohmann::json::parse(taken.out).at("gates").at("wall-move").at("pass").get<bool>());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "e/wall-move.csv"));
  const auto fixed = artus(
      {"validate", "needle", "--only", "wall-vs-classic", "--cutting", "spring", "--out", in("e")});
  EXPECT_EQ(fixed.exit_code, 2);
  EXPECT_THAT(fixed.err, HasSubstr("--cutting"));
  const auto echo = artus({"validate", "echo", "--cutting", "spring", "--out", in("e")});
  EXPECT_EQ(echo.exit_code, 2);
  EXPECT_THAT(echo.err, HasSubstr("--cutting"));
}

TEST_F(Validate, ItsOldNamesDoTheSame) {
  const auto gates = artus({"injection-gates", "--only", "leak", "--out", in("g"), "--json"});
  EXPECT_EQ(gates.exit_code, 0) << gates.err;
  EXPECT_THAT(gates.err, HasSubstr("'artus validate injection'"));
  EXPECT_TRUE(nlohmann::json::parse(gates.out).at("pass").get<bool>());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "g/verdict.json"));
  const auto run = artus({"experiment", "velocity-estimators", "--out", in("e"), "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("'artus validate needle probe'"));
  EXPECT_TRUE(nlohmann::json::parse(run.out).at("velocity-estimators").at("pass").get<bool>());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "e/verdict.json"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "e/tissue"));
}

TEST_F(Validate, WithoutItsProgramTheToolSaysWhatBuildsIt) {
  std::filesystem::copy_file(ARTUS_TOOL, in("artus"));
  const auto r = test::run_process({in("artus"), "validate", "--list"});
  EXPECT_EQ(r.exit_code, 1);
  EXPECT_THAT(r.err, HasSubstr("--target artus_validate"));
}

}  // namespace
}  // namespace artus
