// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/report.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace artus {
namespace {

using testing::HasSubstr;

TEST(TextTable, CellWithACommaOrAQuoteIsQuotedInCsv) {
  const TextTable table{{"a", "b"}, {{"1", "x, y"}, {"say \"so\"", "2"}}};
  EXPECT_EQ(to_csv_text(table), "a,b\n1,\"x, y\"\n\"say \"\"so\"\"\",2\n");
}

TEST(TextTable, MarkdownHasALineForEachRow) {
  EXPECT_EQ(to_markdown(TextTable{{"a", "b"}, {{"1", "2"}}}), "| a | b |\n|---|---|\n| 1 | 2 |\n");
  EXPECT_EQ(to_markdown(TextTable{}), "");
}

TEST(Fixed, RoundsAndAddsTheUnit) {
  EXPECT_EQ(fixed(0.649, 2, "s"), "0.65 s");
  EXPECT_EQ(fixed(-2, 0), "-2");
}

EvidenceReport small_report() {
  EvidenceReport report;
  report.name = "small";
  report.title = "What it shows";
  report.source = "[Somebody1999] fig. 1";
  report.published = {{"force", "1 N", "0.99 N"}};
  report.assumed = {"the speed, 10 mm/s"};
  report.tables = {{"", {{"a"}, {{"1"}}}}};
  report.claims = {claim_at_most(ClaimKind::independent, "off by", 3, 2, "N")};
  return report;
}

TEST(EvidenceReport, TextHasSourcePublishedValuesClaimsAndAssumptions) {
  EvidenceReport report = small_report();
  report.plots = {{"small.svg", {}}};
  const std::string text = to_markdown(report, "small");
  for (const char* part :
       {"What it shows", "Beside [Somebody1999] fig. 1.", "| force | 1 N | 0.99 N |",
        "(small/small.svg)", "| off by | 3 | <= 2 N | independent | **no** |",
        "0 independent hold, 1 fail", "Assumed, without a source:\n\n- the speed, 10 mm/s"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(EvidenceReport, WritesTableTextAndVerdict) {
  const auto folder = std::filesystem::temp_directory_path() / "artus-evidence-report-test";
  std::filesystem::remove_all(folder);
  const auto written = write_report(small_report(), folder);
  ASSERT_TRUE(written) << written.error().to_string();
  std::ifstream csv(folder / "small-table.csv");
  std::stringstream table;
  table << csv.rdbuf();
  EXPECT_EQ(table.str(), "a\n1\n");
  std::ifstream in(folder / "verdict.json");
  const auto json = nlohmann::json::parse(in);
  EXPECT_FALSE(json.at("pass").get<bool>());
  EXPECT_EQ(json.at("assumed").at(0), "the speed, 10 mm/s");
  EXPECT_EQ(json.at("published").at(0).at("artus"), "0.99 N");
  EXPECT_TRUE(std::filesystem::exists(folder / "report.md"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace artus
