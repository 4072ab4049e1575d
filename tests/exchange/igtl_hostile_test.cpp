// SPDX-License-Identifier: AGPL-3.0-or-later
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/exchange/igtl/big_endian.h"
#include "artus/detail/exchange/igtl/checksum.h"
#include "artus/detail/exchange/igtl/contents.h"
#include "artus/detail/exchange/igtl/message.h"
#include "artus/detail/exchange/igtl/stream_reader.h"

namespace artus::igtl {
namespace {

constexpr std::size_t kMax = 4096;  // bytes of a wanted body

/// Reads whatever a message says it is; returns whether it made sense.
bool read_content(const Message& message) {
  const std::string& content = message.content;
  if (message.type == "TRANSFORM") return parse_transform(content).has_value();
  if (message.type == "IMAGE") return parse_image(content).has_value();
  if (message.type == "STRING") return parse_string(content).has_value();
  if (message.type == "SENSOR") return parse_sensor(content).has_value();
  if (message.type == "STATUS") return parse_status(content).has_value();
  if (message.type == "COMMAND") return parse_command(content).has_value();
  return parse_capability(content).has_value();
}

std::vector<Message> sound_messages() {
  Image image;
  image.width = 8;
  image.height = 4;
  image.image_to_reference.leftCols<3>().setIdentity();
  static const std::string kGrey(32, 'g');
  image.grey = kGrey;
  Matrix matrix = Matrix::Zero();
  matrix.leftCols<3>().setIdentity();
  std::vector<Message> messages;
  for (const auto& [type, content] : std::vector<std::pair<std::string, std::string>>{
           {"TRANSFORM", pack_transform(matrix)},
           {"IMAGE", pack_image(image)},
           {"STRING", pack_string("hello")},
           {"SENSOR", pack_sensor({kNewton, {1, 2}})},
           {"STATUS", pack_status({})},
           {"COMMAND", pack_command({1, "Version", 3, "<Command/>"})},
           {"CAPABILITY", pack_capability({"IMAGE"})}})
    for (const int version : {1, 2}) {
      Message message;
      message.version = version;
      message.type = type;
      message.device = "x";
      message.content = content;
      if (version == 2) message.meta = {{"a", "b", 3}};
      messages.push_back(message);
    }
  return messages;
}

/// A random number below n that depends on the two numbers alone.
std::uint64_t below(std::uint64_t n, std::uint64_t i, std::uint64_t j) {
  return mix_bits(mix_bits(i * 0x9E3779B97F4A7C15U) ^ j) % n;
}

/// Makes the check value right again, so that a mutation gets past it.
void mend_checksum(std::string& bytes) {
  if (bytes.size() < kHeaderSize) return;
  BigEndianWriter field;
  field.put(checksum(std::string_view(bytes).substr(kHeaderSize)));
  bytes.replace(50, 8, field.bytes());
}

struct Tally {
  std::size_t refused = 0;
  std::size_t senseless = 0;
  std::size_t sound = 0;
  std::size_t max_kept = 0;
};

void read_into(Tally& tally, std::string_view bytes, std::size_t piece) {
  StreamReader reader([](std::string_view) { return kMax; });
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    const auto taken = reader.take(bytes.substr(at, piece), [&](const Message& message) {
      ++(read_content(message) ? tally.sound : tally.senseless);
    });
    tally.max_kept = std::max(tally.max_kept, reader.kept());
    if (!taken) {
      EXPECT_FALSE(taken.error().message.empty());
      ++tally.refused;
      return;
    }
  }
}

TEST(IgtlHostile, AHundredThousandMutatedMessagesDoNoHarm) {
  const std::vector<Message> sound = sound_messages();
  Tally tally;
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    std::string bytes = pack(sound[below(sound.size(), i, 0)]);
    const std::uint64_t n = 1 + below(4, i, 1);
    for (std::uint64_t k = 0; k < n; ++k) {
      const std::size_t at = below(bytes.size(), i, 10 + k);
      switch (below(4, i, 20 + k)) {
        case 0:
          bytes[at] = static_cast<char>(below(256, i, 30 + k));
          break;
        case 1:
          bytes[at] = static_cast<char>(bytes[at] ^ (1U << below(8, i, 30 + k)));
          break;
        case 2:
          bytes.erase(at, 1 + below(8, i, 30 + k));
          break;
        default:
          bytes.insert(at, 1 + below(8, i, 30 + k), '\xFF');
      }
      if (bytes.empty()) bytes = "x";
    }
    if (below(2, i, 2) == 0) mend_checksum(bytes);
    bytes += pack(sound[below(sound.size(), i, 3)]);
    read_into(tally, bytes, 1 + below(200, i, 4));
  }
  EXPECT_GT(tally.refused, 10'000U);
  EXPECT_GT(tally.senseless, 1'000U);  // past the check value, and refused by its contents
  EXPECT_GT(tally.sound, 10'000U);
  EXPECT_LE(tally.max_kept, 2 * kMax);
}

TEST(IgtlHostile, TenThousandAbsurdMessagesWithRightCheckValuesDoNoHarm) {
  const std::vector<Message> sound = sound_messages();
  Tally tally;
  for (std::uint64_t i = 0; i < 10'000; ++i) {
    Message message = sound[below(sound.size(), i, 0)];
    const std::size_t n = below(300, i, 1);
    message.content.resize(n);
    // Fields at their extremes: where a length stands, it lies.
    const char fill = std::string("\xFF\x7F\x80\0\1", 5)[below(5, i, 2)];
    for (std::size_t k = below(n + 1, i, 3); k < n; ++k) message.content[k] = fill;
    std::string bytes = pack(message);
    if (message.version == 2 && below(2, i, 4) == 0) {
      bytes.replace(kHeaderSize + below(12, i, 5), 1, 1, fill);
      mend_checksum(bytes);
    }
    read_into(tally, bytes, 64);
  }
  EXPECT_GT(tally.senseless, 3'000U);
  EXPECT_LE(tally.max_kept, 2 * kMax);
}

TEST(IgtlHostile, AHeaderThatPromisesMuchTakesNoMemory) {
  StreamReader reader([](std::string_view) { return std::size_t{60U << 20U}; });
  Message message;
  message.type = "IMAGE";
  std::string bytes = pack(message);
  BigEndianWriter size;
  size.put(std::uint64_t{60U << 20U});
  bytes.replace(42, 8, size.bytes());
  ASSERT_TRUE(reader.take(bytes + std::string(100, 'x'), [](const Message&) { FAIL(); }));
  EXPECT_LT(reader.kept(), 1000U);
}

}  // namespace
}  // namespace artus::igtl
