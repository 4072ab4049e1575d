// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdint>
#include <cstdlib>
#include <string>

#include "artus/detail/exchange/igtl/big_endian.h"
#include "artus/detail/exchange/igtl/checksum.h"
#include "artus/detail/exchange/igtl/contents.h"
#include "artus/detail/exchange/igtl/message.h"
#include "artus/detail/exchange/igtl/stream_reader.h"

namespace {

using namespace artus::igtl;  // NOLINT(google-build-using-namespace): a fuzzer of this room

void read_content(const Message& message) {
  const std::string& content = message.content;
  if (const auto image = parse_image(content); image && image->grey.size() > content.size())
    std::abort();
  static_cast<void>(parse_transform(content));
  static_cast<void>(parse_string(content));
  static_cast<void>(parse_sensor(content));
  static_cast<void>(parse_status(content));
  static_cast<void>(parse_command(content));
  static_cast<void>(parse_capability(content));
  Message again = message;
  if (pack(again).size() < kHeaderSize + content.size()) std::abort();
}

void read_stream(std::string_view bytes, std::size_t piece) {
  constexpr std::size_t kMax = 1U << 16U;  // bytes of a wanted body
  StreamReader reader([](std::string_view type) { return type[0] == 'P' ? 0 : kMax; });
  for (std::size_t at = 0; at < bytes.size(); at += piece)
    if (const auto taken = reader.take(bytes.substr(at, piece), read_content); !taken) {
      if (taken.error().message.empty()) std::abort();
      return;
    }
  if (reader.kept() > 2 * kMax) std::abort();
}

}  // namespace

/// A stream of messages, whole and in pieces; and a body behind a header that is right, since
/// random bytes hardly ever have the right check value.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  read_stream(bytes, bytes.size() + 1);
  read_stream(bytes, 7);
  for (const int version : {1, 2}) {
    BigEndianWriter message;
    message.put(static_cast<std::uint16_t>(version));
    message.put_padded("STRING", kTypeSize);
    message.put_padded("fuzz", kNameSize);
    message.put(std::uint64_t{0});
    message.put(static_cast<std::uint64_t>(bytes.size()));
    message.put(checksum(bytes));
    message.put_bytes(bytes);
    read_stream(message.bytes(), message.bytes().size());
  }
  return 0;
}
