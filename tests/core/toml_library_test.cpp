// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/toml_library.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>

namespace artus {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Result<std::vector<std::string>> names_in(std::string_view text) {
  std::vector<std::string> names;
  ARTUS_TRY(parse_library(
      text, "f.toml", "ink",
      [&names](const std::string& name, const toml::table& table, Problems& problems) {
        TomlTable toml(table, "ink '" + name + "'", problems);
        toml.required_text("colour");
        toml.finish();
        names.push_back(name);
      }));
  return names;
}

TEST(TomlLibrary, EntriesComeInTheOrderOfTheFile) {
  const auto names = names_in(R"(
    format = 1
    [ink.red]
    colour = "r"
    [ink.black]
    colour = "k"
    [ink.green]
    colour = "g")");
  ASSERT_TRUE(names) << names.error().to_string();
  EXPECT_THAT(*names, ElementsAre("red", "black", "green"));
}

TEST(TomlLibrary, AllProblemsAreToldAtOnceWithTheirLines) {
  const auto names = names_in("format = 2\n[ink]\nplain = 3\n[ink.Red]\n[ink.black]\nshade = 1\n");
  ASSERT_FALSE(names);
  EXPECT_EQ(names.error().code, ErrorCode::invalid);
  EXPECT_THAT(names.error().to_string(),
              AllOf(HasSubstr("format"), HasSubstr("[ink.plain]"), HasSubstr("[ink.Red]"),
                    HasSubstr("colour"), HasSubstr("shade")));
}

TEST(TomlLibrary, AFileWithoutEntriesSaysHowTheyAreWritten) {
  EXPECT_THAT(names_in("format = 1").error().to_string(), HasSubstr("[ink.NAME]"));
  EXPECT_EQ(names_in("format = ").error().code, ErrorCode::malformed);
}

}  // namespace
}  // namespace artus
