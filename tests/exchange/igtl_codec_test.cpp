// SPDX-License-Identifier: AGPL-3.0-or-later
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/exchange/igtl/big_endian.h"
#include "artus/detail/exchange/igtl/checksum.h"
#include "artus/detail/exchange/igtl/contents.h"
#include "artus/detail/exchange/igtl/message.h"
#include "artus/detail/exchange/igtl/stream_reader.h"

namespace artus::igtl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Matrix some_matrix() {
  Matrix matrix;
  matrix << 0, -1, 0, 12.5, 1, 0, 0, -7.25, 0, 0, 1, 300;
  return matrix;
}

Message make_message(int version) {
  Message message;
  message.version = version;
  message.type = "TRANSFORM";
  message.device = "ProbeToReference";
  message.time = 0x5F3759DF80000000;
  message.content = pack_transform(some_matrix());
  if (version == 2) {
    message.id = 77;
    message.meta = {{"TransformStatus", "OK", 3}, {"empty", "", 106}};
  }
  return message;
}

/// All messages of a stream that may hold bodies of 1000 bytes.
Result<std::vector<Message>> read_all(std::string_view bytes, std::size_t piece) {
  StreamReader reader([](std::string_view) { return std::size_t{1000}; });
  std::vector<Message> messages;
  for (std::size_t at = 0; at < bytes.size(); at += piece)
    ARTUS_TRY(reader.take(bytes.substr(at, piece),
                          [&](const Message& message) { messages.push_back(message); }));
  return messages;
}

/// One bit after another, as the definition of such a check says.
std::uint64_t slow_checksum(std::string_view bytes) {
  std::uint64_t crc = 0;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint64_t>(static_cast<unsigned char>(c)) << 56U;
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc >> 63U) != 0 ? (crc << 1U) ^ 0x42F0E1EBA9EA3693U : crc << 1U;
  }
  return crc;
}

TEST(IgtlChecksum, HasThePublishedCheckValue) {
  EXPECT_EQ(checksum("123456789"), 0x6C40DF5F0B497347U);
}

TEST(IgtlChecksum, IsThatOfTheDefinitionAtAnyLengthAndCut) {
  std::string bytes;
  for (int i = 0; i < 67; ++i) {
    EXPECT_EQ(checksum(bytes), slow_checksum(bytes)) << i;
    const std::string_view all(bytes);
    const std::size_t cut = bytes.size() / 3;
    EXPECT_EQ(checksum(all.substr(cut), checksum(all.substr(0, cut))), checksum(all));
    bytes.push_back(static_cast<char>(37 * i + 11));
  }
}

TEST(IgtlMessage, AHeaderHasItsFieldsWhereTheProtocolHasThem) {
  const std::string bytes = pack(make_message(1));
  ASSERT_EQ(bytes.size(), 58U + 48U);
  EXPECT_EQ(bytes.substr(0, 2), std::string("\0\1", 2));
  EXPECT_EQ(bytes.substr(2, 12), std::string("TRANSFORM\0\0\0", 12));
  EXPECT_EQ(bytes.substr(14, 20), std::string("ProbeToReference\0\0\0\0", 20));
  EXPECT_EQ(bytes.substr(34, 8), std::string("\x5F\x37\x59\xDF\x80\0\0\0", 8));
  EXPECT_EQ(bytes.substr(42, 8), std::string("\0\0\0\0\0\0\0\x30", 8));
}

TEST(IgtlMessage, EveryVersionComesBackAsItWasSent) {
  for (const int version : {1, 2}) {
    const Message sent = make_message(version);
    const auto got = read_all(pack(sent), 1000);
    ASSERT_TRUE(got) << got.error().to_string();
    ASSERT_EQ(got->size(), 1U);
    const Message& back = got->front();
    EXPECT_EQ(back.version, version);
    EXPECT_EQ(back.type, sent.type);
    EXPECT_EQ(back.device, sent.device);
    EXPECT_EQ(back.time, sent.time);
    EXPECT_EQ(back.id, sent.id);
    EXPECT_EQ(back.content, sent.content);
    EXPECT_EQ(back.meta, sent.meta);
  }
}

TEST(IgtlMessage, HeaderTwoPutsMetadataBehindTheContent) {
  Message message = make_message(2);
  message.meta = {{"Status", "SUCCESS", 3}};
  const std::string bytes = pack(message);
  const std::size_t content = 58 + 12;
  ASSERT_EQ(bytes.size(), content + 48 + 2 + 8 + 13);
  EXPECT_EQ(bytes.substr(58, 12), std::string("\0\x0C\0\x0A\0\0\0\x0D\0\0\0\x4D", 12));
  EXPECT_EQ(bytes.substr(content + 48, 10), std::string("\0\1\0\6\0\3\0\0\0\7", 10));
  EXPECT_EQ(bytes.substr(content + 58), "StatusSUCCESS");
}

TEST(IgtlMessage, NamesThatAreTooLongAreCut) {
  Message message = make_message(1);
  message.device = "AVeryLongNameOfMoreThanTwentyBytes";
  const auto got = read_all(pack(message), 1000);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->front().device, "AVeryLongNameOfMoreT");
}

TEST(IgtlMessage, TimesAreSecondsSince1970) {
  EXPECT_DOUBLE_EQ(seconds_of(std::uint64_t{3} << 31U), 1.5);
  EXPECT_GT(seconds_of(utc_time_now()), 1.7e9);
  EXPECT_LT(seconds_of(utc_time_now()), 4.3e9);
}

TEST(IgtlMessage, AFlippedBitIsFound) {
  std::string bytes = pack(make_message(1));
  bytes.back() = static_cast<char>(bytes.back() ^ 4);
  const auto got = read_all(bytes, 1000);
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().code, ErrorCode::corrupt);
}

TEST(IgtlMessage, AHeaderThatCannotBeIsRefusedWithTheReason) {
  const std::string good = pack(make_message(1));
  const auto refusal = [&](std::size_t at, std::string_view bytes) {
    std::string bad = good;
    bad.replace(at, bytes.size(), bytes);
    const auto got = read_all(bad, 1000);
    return got ? std::string("taken") : got.error().message;
  };
  EXPECT_THAT(refusal(0, std::string_view("\0\3", 2)), HasSubstr("header version 3"));
  EXPECT_THAT(refusal(2, std::string_view("\0", 1)), HasSubstr("not text"));
  EXPECT_THAT(refusal(3, "\x01"), HasSubstr("not text"));
  EXPECT_THAT(refusal(42, "\xFF\xFF\xFF\xFF"), HasSubstr("at most 64 MiB"));
  EXPECT_THAT(refusal(46, std::string_view("\0\0\7\xFF", 4)), HasSubstr("at most 1000"));
}

TEST(IgtlMessage, AnExtensionThatLiesIsRefused) {
  const Message good = make_message(2);
  const std::string bytes = pack(good);
  for (const auto& [at, lie] :
       std::vector<std::pair<std::size_t, std::string>>{
           {58, std::string("\0\x0B", 2)},   // shorter than it is
           {58, "\xFF\xFF"},                 // longer than the body
           {60, "\xFF\xFF"},                 // metadata's header
           {62, "\xFF\xFF\xFF\xFF"},         // metadata
           {58 + 12 + 48, "\xFF\xFF"},       // more entries than there is room for
           {58 + 12 + 48 + 2, "\xFF\xFF"}})  // a key that is longer than all of them
  {
    std::string bad = bytes;
    bad.replace(at, lie.size(), lie);
    BigEndianWriter crc;
    crc.put(checksum(std::string_view(bad).substr(58)));
    bad.replace(50, 8, crc.bytes());
    const auto got = read_all(bad, 1000);
    ASSERT_FALSE(got) << at;
    EXPECT_EQ(got.error().code, ErrorCode::malformed) << at;
  }
}

TEST(IgtlStreamReader, TakesMessagesInPiecesOfAnySize) {
  const std::string bytes = pack(make_message(1)) + pack(make_message(2)) + pack(make_message(1));
  for (const std::size_t piece : {1U, 7U, 58U, 106U, 1000U}) {
    const auto got = read_all(bytes, piece);
    ASSERT_TRUE(got) << got.error().to_string();
    EXPECT_EQ(got->size(), 3U) << piece;
  }
}

TEST(IgtlStreamReader, AMessageWithoutABodyIsWholeAtOnce) {
  Message message;
  message.type = "GET_STATUS";
  const auto got = read_all(pack(message), 58);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->size(), 1U);
}

TEST(IgtlStreamReader, PassesOverWhatNobodyWantsWithoutKeepingIt) {
  Message large = make_message(1);
  large.type = "POLYDATA";
  large.content.assign(5'000'000, 'x');
  StreamReader reader(
      [](std::string_view type) { return type == "TRANSFORM" ? std::size_t{1000} : 0; });
  const std::string bytes = pack(large) + pack(make_message(2));
  int n = 0;
  std::size_t most = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 4096) {
    ASSERT_TRUE(
        reader.take(std::string_view(bytes).substr(at, 4096), [&](const Message&) { ++n; }));
    most = std::max(most, reader.kept());
  }
  EXPECT_EQ(n, 1);
  EXPECT_EQ(reader.passed_over(), 1U);
  EXPECT_EQ(reader.version(), 2);
  EXPECT_LT(most, 1000U);
}

TEST(IgtlStreamReader, ALostStreamStaysLost) {
  StreamReader reader([](std::string_view) { return std::size_t{1000}; });
  EXPECT_FALSE(reader.take(std::string(58, 'x'), [](const Message&) {}));
  EXPECT_FALSE(reader.take(pack(make_message(1)), [](const Message&) { FAIL(); }));
}

TEST(IgtlContents, ATransformIsColumnsThenPlace) {
  const std::string content = pack_transform(some_matrix());
  ASSERT_EQ(content.size(), 48U);
  BigEndianReader in(content);
  std::vector<float> numbers(12);
  for (float& number : numbers) number = in.get<float>();
  EXPECT_THAT(numbers, ElementsAre(0, 1, 0, -1, 0, 0, 0, 0, 1, 12.5F, -7.25F, 300));
  const auto back = parse_transform(content);
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, some_matrix());
}

TEST(IgtlContents, ATransformOfOtherLengthOrWithoutNumbersIsRefused) {
  EXPECT_FALSE(parse_transform(std::string(47, '\0')));
  EXPECT_FALSE(parse_transform(std::string(49, '\0')));
  Matrix bad = some_matrix();
  bad(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(parse_transform(pack_transform(bad)).error().code, ErrorCode::invalid);
}

TEST(IgtlContents, AnImageIsPlacedByItsMiddle) {
  Image image;
  image.width = 5;
  image.height = 3;
  image.image_to_reference << 2, 0, 0, 10, 0, 0, -2, 20, 0, 2, 0, 30;
  const std::string grey = "abcdefghijklmno";
  image.grey = grey;
  const std::string content = pack_image(image);
  BigEndianReader in(std::string_view(content).substr(12 + 36, 12));
  EXPECT_EQ(in.get<float>(), 14);  // 10 + 2 * (5 - 1) / 2
  EXPECT_EQ(in.get<float>(), 20);
  EXPECT_EQ(in.get<float>(), 32);  // 30 + 2 * (3 - 1) / 2
  const auto back = parse_image(content);
  ASSERT_TRUE(back) << back.error().to_string();
  EXPECT_EQ(back->grey, grey);
  EXPECT_EQ(back->image_to_reference, image.image_to_reference);
}

TEST(IgtlContents, AnImageWhoseSizeLiesIsRefused) {
  Image image;
  image.width = 5;
  image.height = 3;
  image.image_to_reference.leftCols<3>().setIdentity();
  image.grey = "abcdefghijklmno";
  const std::string good = pack_image(image);
  for (const auto& [at, lie] : std::vector<std::pair<std::size_t, char>>{
           {2, 3}, {3, 11}, {7, 6}, {9, 4}, {11, 2}, {61, 1}, {67, 4}, {7, 0}}) {
    std::string bad = good;
    bad[at] = lie;
    EXPECT_FALSE(parse_image(bad)) << at;
  }
  EXPECT_FALSE(parse_image(good.substr(0, 60)));
}

TEST(IgtlContents, TextsAndNumbersComeBack) {
  EXPECT_EQ(*parse_string(pack_string("1.5 N")), "1.5 N");
  EXPECT_EQ(parse_string(pack_string(std::string(70'000, 'x')))->size(), 65535U);
  EXPECT_FALSE(parse_string(pack_string("1.5 N") + "x"));
  const auto sensor = parse_sensor(pack_sensor({kNewton, {1, -2.5, 3}}));
  ASSERT_TRUE(sensor);
  EXPECT_EQ(sensor->unit, kNewton);
  EXPECT_THAT(sensor->values, ElementsAre(1, -2.5, 3));
  EXPECT_FALSE(parse_sensor(pack_sensor({kNewton, {1}}) + "x"));
  const auto status = parse_status(pack_status({Status::kOk, -5, "None", "ready"}));
  ASSERT_TRUE(status);
  EXPECT_EQ(status->subcode, -5);
  EXPECT_EQ(status->error, "None");
  EXPECT_EQ(status->message, "ready");
  const auto command = parse_command(pack_command({9, "Version", 3, "<Command/>"}));
  ASSERT_TRUE(command);
  EXPECT_EQ(command->number, 9U);
  EXPECT_EQ(command->name, "Version");
  EXPECT_EQ(command->content, "<Command/>");
  EXPECT_FALSE(parse_command(pack_command({9, "Version", 3, "<Command/>"}) + "x"));
  EXPECT_THAT(*parse_capability(pack_capability({"IMAGE", "TRANSFORM"})),
              ElementsAre("IMAGE", "TRANSFORM"));
  EXPECT_FALSE(parse_capability("IMAGE"));
}

}  // namespace
}  // namespace artus::igtl
