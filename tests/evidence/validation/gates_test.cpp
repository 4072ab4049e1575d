// SPDX-License-Identifier: AGPL-3.0-or-later
// The one table of gates: names, refusals, reports.
#include "artus/detail/evidence/validation/gates.h"

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/evidence/validation/gate_report.h"
#include "artus/detail/evidence/validation/needle/experiment.h"

namespace artus {
namespace {

using testing::HasSubstr;

TEST(GateTable, EachEntryIsOfAKnownSetHasATitleAndANameOfItsOwn) {
  std::set<std::pair<std::string_view, std::string_view>> seen;
  for (const GateEntry& entry : gate_entries()) {
    EXPECT_TRUE(find_gate_set(entry.set)) << entry.set;
    EXPECT_FALSE(entry.title.empty()) << entry.name;
    EXPECT_TRUE(seen.emplace(entry.set, entry.name).second) << entry.set << ' ' << entry.name;
  }
  for (const GateSet& set : gate_sets()) EXPECT_FALSE(gate_names(set.name).empty()) << set.name;
}

TEST(GateTable, UnknownNamesAreRefusedWithTheNamesThereAre) {
  for (const auto& [set, known] : {std::pair("needle", "wall-seven"),
                                   {"echo", "needle-rings"},
                                   {"soft", "punch"},
                                   {"injection", "aspiration"},
                                   {"probe", "probe-ssp"}}) {
    const auto refused = run_gate(set, "no-such");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::not_found);
    EXPECT_THAT(refused.error().message, HasSubstr(known));
  }
  EXPECT_THAT(find_gate_set("softt").error().message, HasSubstr("injection"));
}

TEST(GateTable, AGateSaysWhatItNeeds) {
  EXPECT_THAT(run_gate("soft", "joint-pressed").error().message, HasSubstr("needs -j"));
  EXPECT_THAT(run_gate("echo", "muscle-patch").error().message, HasSubstr("--reference"));
  EXPECT_THAT(gate_names("soft", {}), testing::Not(testing::Contains("joint-still")));
}

TEST(GateTable, ALawOfTheNeedleIsRefusedWhereThereIsNone) {
  GateOptions options;
  options.feel.cutting.all = CuttingLaw::voigt;
  for (const auto& [set, name] : {std::pair("soft", "patch"), {"probe", "probe-study"}}) {
    const auto refused = run_gate(set, name, options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "cutting");
  }
}

/// A set of two gates: one of one claim that fails, one with a table of tissue beside.
MeasuredSet small_set(std::string_view name) {
  Gate fails;
  fails.name = "fails";
  fails.title = "What fails";
  fails.claims = {claim_at_most({ClaimKind::fitted, "by |this|"}, "off by", 3, 2, "N")};
  Gate beside;
  beside.name = "beside";
  beside.title = "What is beside";
  beside.claims = {claim_at_most(ClaimKind::independent, "near", 1, 2, "N")};
  beside.tables = {
      {std::string(kBesideTable),
       {{"claim", "bound", "rigid", "with tissue"}, {{"near", "<= 2 N", "holds, 1", "FAILS, 3"}}}}};
  beside.files = {{"kept/trace.csv", [](const std::filesystem::path& file) -> Result<void> {
                     std::ofstream(file) << "1\n";
                     return {};
                   }}};
  return {*find_gate_set(name), {fails, beside}};
}

TEST(GateReport, AVerdictNamesTheGateOfEachClaimAndCountsThem) {
  const auto json = verdict(small_set("soft"));
  EXPECT_FALSE(json.at("pass").get<bool>());
  EXPECT_EQ(json.at("claims").at(0).at("claim"), "fails: off by");
  EXPECT_EQ(json.at("counts").at("independent").at("hold"), 1);
  EXPECT_EQ(json.at("gates").at("beside").at("with_tissue").at("near"), "FAILS, 3");
  const std::vector<MeasuredSet> two{small_set("needle"), small_set("probe")};
  const auto both = verdict(two);
  EXPECT_FALSE(both.at("sets").at("probe").at("pass").get<bool>());
  EXPECT_TRUE(both.at("beside").at("pass").get<bool>()) << "as `artus experiment` told it";
}

TEST(GateReport, GatesThatAreKeptApartHaveAFolderEach) {
  const auto folder = std::filesystem::temp_directory_path() / "artus-gate-report-test";
  for (const auto& [set, report, trace] :
       {std::tuple("soft", "report.md", "kept/trace.csv"),
        {"needle", "beside/report.md", "beside/kept/trace.csv"}}) {
    std::filesystem::remove_all(folder);
    const auto written = write_report(small_set(set), folder);
    ASSERT_TRUE(written) << written.error().to_string();
    for (const std::string& file :
         {std::string("report.md"), std::string("verdict.json"), std::string(set) + "-table.csv",
          std::string(report), std::string(trace)})
      EXPECT_TRUE(std::filesystem::exists(folder / file)) << set << ' ' << file;
  }
  std::filesystem::remove_all(folder);
}

TEST(GateReport, APageOfResultsHasItsOriginAndARowForEachClaim) {
  const Provenance from{"2026-11-26", "abc123", "artus validate soft", "a processor", "GCC", "Dev"};
  const std::string page = results_page(small_set("soft"), from);
  for (const char* part :
       {"| date | 2026-11-26 |", "| commit | abc123 |", "| command | `artus validate soft` |",
        "| off by | fitted: by \\|this\\| | 3 | <= 2 N | **no** |",
        "| near | independent | 1 | <= 2 N | yes |", "| near | <= 2 N | holds, 1 | FAILS, 3 |",
        "1 independent hold, 0 fail; 1 fitted (1 fails)"})
    EXPECT_THAT(page, HasSubstr(part));
  const Provenance here = find_provenance("artus validate");
  EXPECT_EQ(here.date.size(), 10U);
  for (const std::string& text : {here.commit, here.processor, here.compiler, here.build_type})
    EXPECT_FALSE(text.empty());
}

}  // namespace
}  // namespace artus
