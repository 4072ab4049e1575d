// SPDX-License-Identifier: AGPL-3.0-or-later
// The readers and writers of text and bytes.
#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>

#include "artus/detail/core/byte_stream.h"
#include "artus/detail/core/csv.h"
#include "artus/detail/core/markup.h"
#include "artus/detail/core/plain_reason.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/progress.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/core/toml_table.h"
#include "artus/detail/core/units.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using testing::HasSubstr;

TEST(ForLines, GivesWhatIsNotBlankWithItsPlaceWhateverEndsALine) {
  std::vector<std::string> seen;
  const auto read = for_lines("\xef\xbb\xbfone\r\n\n  \ntwo  \nthree", "list.csv",
                              [&](std::string_view line, const std::string& where) -> Result<void> {
                                seen.push_back(where + "=" + std::string(line));
                                return {};
                              });
  ASSERT_TRUE(read);
  EXPECT_THAT(seen, testing::ElementsAre("list.csv:1=one", "list.csv:4=two", "list.csv:5=three"));
  int calls = 0;
  const auto ended = for_lines("a\nb\n", "f", [&](std::string_view, const std::string& where) {
    ++calls;
    return Result<void>(fail(ErrorCode::invalid, "no", where));
  });
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().where, "f:1");
  EXPECT_EQ(calls, 1);
}

TEST(Markup, TextStaysText) {
  EXPECT_EQ(escape_markup("<b title=\"x\">&amp;"), "&lt;b title=&quot;x&quot;&gt;&amp;amp;");
}

TEST(Csv, ExactNumbersComeBackAndTextIsOneField) {
  for (const double value : {0.1, -1.0 / 3, 6.02214076e23, 1e-300, -0.0})
    EXPECT_EQ(std::stod(to_exact_csv(value)), value);
  EXPECT_EQ(to_exact_csv(0.5), "0.5");
  EXPECT_EQ(quoted_csv("a \"b\", c"), "\"a \"\"b\"\", c\"");
}

TEST(ByteStream, WhatWasPutComesBackInOrder) {
  ByteWriter out;
  out.put(1.25);
  out.put(std::uint16_t{7});
  out.put(std::string_view("text"));
  out.put_array(std::vector<double>{1, 2, 3});
  ByteReader in(out.bytes());
  EXPECT_EQ(in.get<double>(), 1.25);
  EXPECT_EQ(in.get<std::uint16_t>(), 7);
  EXPECT_EQ(in.get_text(), "text");
  EXPECT_EQ(in.get_array<double>(), (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(in.ok());
  EXPECT_TRUE(in.at_end());
}

TEST(ByteStream, WhatIsNotThereIsZeroFromThenOn) {
  ByteWriter out;
  out.put(std::uint32_t{5});
  ByteReader in(out.bytes());
  EXPECT_EQ(in.get<double>(), 0);
  EXPECT_FALSE(in.ok());
  EXPECT_EQ(in.get<std::uint32_t>(), 0U) << "also what would have been there";
}

TEST(ByteStream, ALengthThatCannotBeIsRefusedBeforeItIsAllocated) {
  ByteWriter out;
  out.put(std::numeric_limits<std::uint64_t>::max());
  ByteReader in(out.bytes());
  EXPECT_TRUE(in.get_array<double>().empty());
  EXPECT_FALSE(in.ok());
  ByteWriter count;
  count.put(std::uint32_t{1'000'000'000});
  ByteReader elements(count.bytes());
  EXPECT_EQ(elements.get_count(8), 0U);
  EXPECT_FALSE(elements.ok());
}

TEST(HashBytes, ChangesWithEveryBitAndWithTheSeed) {
  const std::string bytes = "a text of more than sixteen bytes";
  const std::uint64_t before = hash_bytes(bytes);
  EXPECT_EQ(hash_bytes(bytes), before);
  EXPECT_NE(hash_bytes(bytes, 1), before);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ (1 << bit));
      EXPECT_NE(hash_bytes(changed), before);
    }
  }
  EXPECT_NE(hash_bytes(std::string("\0", 1)), hash_bytes(""));
}

TEST(Csv, NumbersHaveNineDigitsAPointAndNoNegativeZero) {
  EXPECT_EQ(to_csv(1.0 / 3), "0.333333333");
  EXPECT_EQ(to_csv(-0.0), "0");
  EXPECT_EQ(to_csv(1e-7), "1e-07");
  EXPECT_EQ(to_csv(12345), "12345");
}

TEST(TextCursor, WalksTokensAndCountsLines) {
  TextCursor text("one  two\n\nthree\t4.5 6\nrest of it\nend", "file", 10);
  EXPECT_EQ(text.next(), "one");
  EXPECT_EQ(text.next_in_line(), "two");
  EXPECT_EQ(text.next_in_line(), "") << "the line ends here";
  EXPECT_EQ(text.line(), 10U);
  EXPECT_EQ(text.next(), "three");
  EXPECT_EQ(text.where(), "file:12");
  EXPECT_EQ(text.next_number(), 4.5);
  EXPECT_EQ(text.next_integer(), 6);
  EXPECT_EQ(text.next(), "rest");
  text.skip_line();
  EXPECT_EQ(text.next(), "end");
  EXPECT_TRUE(text.at_end());
  EXPECT_EQ(text.next_number(), std::nullopt);
  EXPECT_EQ(text.malformed("no").value().code, ErrorCode::malformed);
}

TEST(ParseNumber, TakesDecimalsWithAPointAndNothingElse) {
  EXPECT_EQ(parse_number("+1.5e2"), 150);
  EXPECT_EQ(parse_number("1e999"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_number("-1e999"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_number("1e-999"), 0);
  EXPECT_TRUE(std::isnan(parse_number("nan").value_or(0)));
  for (const char* wrong : {"", "1,5", "0x10", "1.5mm", "+-1", "e5"})
    EXPECT_EQ(parse_number(wrong), std::nullopt) << wrong;
  EXPECT_EQ(parse_integer("-12"), -12);
  for (const char* wrong : {"", "1.0", "99999999999999999999"})
    EXPECT_EQ(parse_integer(wrong), std::nullopt) << wrong;
}

TEST(AppendNumber, IsTheShortestThatReadsBack) {
  for (const double value : {0.1, 1.0 / 3, 6.02e23, -4.9e-324}) {
    std::string text;
    append_number(text, value);
    EXPECT_EQ(parse_number(text), value) << text;
  }
  std::string text;
  append_number(text, 0.1);
  EXPECT_EQ(text, "0.1");
}

TEST(Quoted, HidesWhatATerminalWouldObeyAndShortensTheRest) {
  EXPECT_EQ(artus::quoted("a\x1b[31m"), "'a?[31m'");
  EXPECT_EQ(artus::quoted(std::string(50, 'x')), "'" + std::string(40, 'x') + "...'");
}

class TextFiles : public test::TemporaryFolder {};

TEST_F(TextFiles, AreWrittenWithTheFoldersOnTheWayAndReadByteForByte) {
  const std::string text("one\0two\r\n", 9);
  ASSERT_TRUE(write_text(in("a/b/c.txt"), text));
  EXPECT_EQ(read_bytes(in("a/b/c.txt")).value(), text);
  EXPECT_EQ(read_bytes(in("absent")).error().code, ErrorCode::not_found);
  EXPECT_EQ(read_bytes(in("a")).error().code, ErrorCode::unreadable) << "a folder";
  EXPECT_EQ(write_text(in("a"), text).error().code, ErrorCode::unreadable);
  ASSERT_TRUE(make_folder(in("d/e")));
  EXPECT_TRUE(make_folder(in("d/e"))) << "it is there";
  EXPECT_TRUE(std::filesystem::is_directory(in("d/e")));
  for (const std::string& file : {in("a/b/c.txt"), in("a/b/c.txt/d")}) {
    const auto made = make_folder(file);
    ASSERT_FALSE(made) << "a file is in its place";
    EXPECT_EQ(made.error().where, file);
  }
}

/// A table taken apart and what was wrong with it.
struct Taken {
  explicit Taken(const char* text)
      : table(*parse_toml(text, "t")), toml(table, "thing", problems) {}
  std::string message() {
    toml.finish();
    return problems.empty() ? "" : problems.refusal(ErrorCode::invalid, "t").value().message;
  }
  toml::table table;
  Problems problems;
  TomlTable toml;
};

TEST(TomlTable, GivesTypedValuesInTheUnitAskedFor) {
  Taken t("a = 'x'\nb = 2\nc = true\nd = [1, 2.5, 3]\ne = ['p', 'q']\n[f]\n[[g]]\n[[g]]\n");
  EXPECT_EQ(t.toml.required_text("a"), "x");
  EXPECT_EQ(t.toml.number("b", 0, 10, 1e-3), 2e-3);
  EXPECT_EQ(t.toml.boolean("c"), true);
  EXPECT_EQ(t.toml.required_vector("d"), Vec3(1, 2.5, 3));
  EXPECT_EQ(t.toml.required_texts("e"), (std::vector<std::string>{"p", "q"}));
  EXPECT_NE(t.toml.table("f"), nullptr);
  EXPECT_EQ(t.toml.tables("g").size(), 2U);
  EXPECT_EQ(t.toml.text("absent"), std::nullopt);
  EXPECT_EQ(t.message(), "");
}

TEST(TomlTable, TellsEveryProblemAtItsPlaceAndTheNearestKnownKey) {
  Taken t("depth = 'deep'\nwidht = 3\nplace = [1, 2]\n");
  EXPECT_EQ(t.toml.required_number("depth", 0, 10), 0);
  EXPECT_EQ(t.toml.number("width", 0, 10), std::nullopt);
  EXPECT_EQ(t.toml.vector("place"), std::nullopt);
  EXPECT_EQ(t.toml.required_text("name"), "");
  const std::string message = t.message();
  EXPECT_THAT(message, HasSubstr("4 problems"));
  EXPECT_THAT(message, HasSubstr("1:9: thing: 'depth' must be a number from 0 to 10"));
  EXPECT_THAT(message, HasSubstr("2:1: thing: unknown key 'widht' (did you mean 'width'?)"));
  EXPECT_THAT(message, HasSubstr("'place' must be three numbers"));
  EXPECT_THAT(message, HasSubstr("'name' is missing"));
}

TEST(ParseToml, ASyntaxErrorHasLineAndColumn) {
  const auto table = parse_toml("a = 1\nb = = 2\n", "file");
  ASSERT_FALSE(table);
  EXPECT_THAT(table.error().where, HasSubstr("file:2:"));
}

TEST(PlainName, IsLettersDigitsAndOneMore) {
  EXPECT_TRUE(is_plain_name("a_1", '_'));
  for (const char* wrong : {"", "A", "a-b", "a b"})
    EXPECT_FALSE(is_plain_name(wrong, '_')) << wrong;
}

TEST(Printed, IsWhatPrintfPrintsHoweverLong) {
  EXPECT_EQ(printed("%.1f mm of %s", 2.25, "fat"), "2.2 mm of fat");
  EXPECT_EQ(printed("nothing"), "nothing");
  const std::string name(5000, 'a');
  EXPECT_EQ(printed("<%s>", name.c_str()), "<" + name + ">");
}

TEST(Trimmed, LosesWhatIsBlankAroundIt) {
  EXPECT_EQ(trimmed("\t a b \r\n"), "a b");
  EXPECT_EQ(trimmed(std::string_view("x\0\0", 3)), "x");
  EXPECT_EQ(trimmed("  \n"), "");
}

TEST(PlainReason, LosesALibrarysMarkAndNothingElse) {
  EXPECT_EQ(plain_reason("[json.exception.type_error.302] type must be number"),
            "type must be number");
  EXPECT_EQ(plain_reason("no [space] left"), "no [space] left");
  EXPECT_EQ(plain_reason("[]"), "[]");
}

TEST(Units, AreTheirDefinitions) {
  EXPECT_DOUBLE_EQ(kDegree * 180, std::numbers::pi);
  EXPECT_DOUBLE_EQ(kDecibelPerNeper, 20 / std::log(10.0));
  EXPECT_DOUBLE_EQ(kMillimetre * 1000, 1);
}

TEST(ProgressListener, MayBeNobody) {
  EXPECT_FALSE(Progress{});
}

}  // namespace
}  // namespace artus
