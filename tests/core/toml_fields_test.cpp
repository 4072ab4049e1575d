// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/toml_fields.h"

#include <array>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

namespace artus {
namespace {

using ::testing::HasSubstr;

struct Box {
  double width = 7;
  double weight = 8;
};
constexpr std::array<TomlField<Box>, 2> kBox{{
    {"width_mm", &Box::width, 1, 100, 1e-3, true},
    {"weight_kg", &Box::weight, 0, 5},
}};
enum class Colour { red, green };
constexpr std::array<std::string_view, 2> kColours{"red", "green"};

/// Everything that is wrong with `text` read as a box.
std::string problems_of(const char* text, Box& box, bool is_new = true) {
  const auto table = parse_toml(text, "file");
  Problems problems;
  TomlTable toml(*table, "box", problems);
  Colour colour{};
  read_fields(toml, kBox, box, is_new);
  read_name(toml, "colour", kColours, colour);
  toml.finish();
  return problems.empty() ? "" : problems.refusal(ErrorCode::invalid, "file").value().message;
}

TEST(TomlFields, BecomeMembersInSi) {
  Box box;
  EXPECT_EQ(problems_of("width_mm = 20", box), "");
  EXPECT_DOUBLE_EQ(box.width, 0.02);
  EXPECT_EQ(box.weight, 8) << "what the file does not say stays";
}

TEST(TomlFields, OneThatIsMissingIsToldOfANewStructAlone) {
  Box box;
  EXPECT_THAT(problems_of("weight_kg = 1", box), HasSubstr("'width_mm' is missing"));
  EXPECT_EQ(problems_of("weight_kg = 1", box, false), "");
}

TEST(TomlFields, ARangeIsToldInTheUnitOfTheFile) {
  Box box;
  EXPECT_THAT(problems_of("width_mm = 101", box), HasSubstr("from 1 to 100"));
  EXPECT_EQ(box.width, 7);
}

TEST(TomlFields, WhatIsNoTomlNamesTheGuideOfJointsForAJointAlone) {
  EXPECT_THAT(parse_toml("x", "a/joint.toml").error().message, HasSubstr("docs/joint-format.md"));
  EXPECT_EQ(parse_toml("x", "lab.toml").error().message.find("joint"), std::string::npos);
}

TEST(TomlFields, ANameIsOneOfItsRow) {
  const auto table = parse_toml("colour = 'green'\nother = 'gren'\n", "file");
  Problems problems;
  TomlTable toml(*table, "box", problems);
  Colour colour{};
  read_name(toml, "colour", kColours, colour);
  EXPECT_EQ(colour, Colour::green);
  EXPECT_TRUE(problems.empty());
  read_name(toml, "other", kColours, colour);
  EXPECT_EQ(colour, Colour::green);
  EXPECT_THAT(problems.refusal(ErrorCode::invalid, "file").value().message,
              HasSubstr("other is 'gren', must be one of red, green (did you mean 'green'?)"));
}

}  // namespace
}  // namespace artus
