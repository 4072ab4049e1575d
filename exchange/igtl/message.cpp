// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/igtl/message.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/exchange/igtl/big_endian.h"
#include "artus/detail/exchange/igtl/checksum.h"

namespace artus::igtl {
namespace {

constexpr std::size_t kExtensionSize = 12;  // bytes
constexpr std::size_t kMetaEntrySize = 8;   // bytes of an entry in the metadata's header

bool is_text(std::string_view text) noexcept {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

/// Header and data of the metadata.
std::pair<std::string, std::string> pack_meta(const std::vector<MetaEntry>& meta) {
  constexpr std::size_t kMax = 0xFFFF;  // of entries, and bytes of a key
  BigEndianWriter index;
  std::string data;
  const std::size_t n = std::min((kMax - 2) / kMetaEntrySize, meta.size());
  index.put(static_cast<std::uint16_t>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const std::string_view key = std::string_view(meta[i].key).substr(0, kMax);
    index.put(static_cast<std::uint16_t>(key.size()));
    index.put(meta[i].encoding);
    index.put(static_cast<std::uint32_t>(meta[i].value.size()));
    data.append(key).append(meta[i].value);
  }
  return {std::move(index.bytes()), std::move(data)};
}

Result<std::vector<MetaEntry>> parse_meta(std::string_view index_bytes, std::string_view data) {
  const auto refuse = [] {
    return fail(ErrorCode::malformed, "the metadata does not fit into its message");
  };
  std::vector<MetaEntry> meta;
  if (index_bytes.empty() && data.empty()) return meta;
  BigEndianReader index(index_bytes);
  BigEndianReader values(data);
  const auto n = index.get<std::uint16_t>();
  if (!index.ok() || n > index.rest().size() / kMetaEntrySize) return refuse();
  for (int i = 0; i < n; ++i) {
    const auto key_size = index.get<std::uint16_t>();
    const auto encoding = index.get<std::uint16_t>();
    const auto value_size = index.get<std::uint32_t>();
    const std::string_view key = values.get_bytes(key_size);
    const std::string_view value = values.get_bytes(value_size);
    if (!index.ok() || !values.ok()) return refuse();
    meta.push_back({std::string(key), std::string(value), encoding});
  }
  return meta;
}

}  // namespace

std::string_view Message::meta_value(std::string_view key) const noexcept {
  const auto found = std::find_if(meta.begin(), meta.end(),
                                  [key](const MetaEntry& entry) { return entry.key == key; });
  return found == meta.end() ? std::string_view() : std::string_view(found->value);
}

Result<Header> parse_header(std::string_view bytes) {
  ARTUS_REQUIRE(bytes.size() == kHeaderSize, "a header must have 58 bytes");
  BigEndianReader in(bytes);
  Header header;
  header.version = in.get<std::uint16_t>();
  header.type = in.get_padded(kTypeSize);
  header.device = in.get_padded(kNameSize);
  header.time = in.get<std::uint64_t>();
  header.body_size = in.get<std::uint64_t>();
  header.checksum = in.get<std::uint64_t>();
  if (header.version != 1 && header.version != 2)
    return fail(ErrorCode::unsupported,
                "header version " + std::to_string(header.version) + "; only 1 and 2 can be read");
  if (header.type.empty() || !is_text(header.type) || !is_text(header.device))
    return fail(ErrorCode::malformed, "the message's type or device name is not text");
  if (header.body_size > kLargestBody)
    return fail(ErrorCode::invalid,
                "a body of " + std::to_string(header.body_size) + " bytes; at most 64 MiB");
  return header;
}

Result<Message> unpack(const Header& header, std::string body) {
  if (body.size() != header.body_size)
    return fail(ErrorCode::corrupt, "the body is not as long as its header says");
  if (checksum(body) != header.checksum)
    return fail(ErrorCode::corrupt, "the checksum does not match the body of " + header.type +
                                        " '" + header.device + "'");
  Message message;
  message.version = header.version;
  message.type = header.type;
  message.device = header.device;
  message.time = header.time;
  if (header.version == 1) {
    message.content = std::move(body);
    return message;
  }
  BigEndianReader in(body);
  const auto extension = in.get<std::uint16_t>();
  const std::size_t index_size = in.get<std::uint16_t>();
  const std::size_t data_size = in.get<std::uint32_t>();
  message.id = in.get<std::uint32_t>();
  if (!in.ok() || extension < kExtensionSize || extension > body.size() ||
      index_size + data_size > body.size() - extension)
    return fail(ErrorCode::malformed, "header 2's extension does not fit into its body");
  const std::size_t end = body.size() - index_size - data_size;
  auto meta = parse_meta(std::string_view(body).substr(end, index_size),
                         std::string_view(body).substr(end + index_size));
  ARTUS_TRY(meta);
  message.meta = std::move(*meta);
  message.content = body.substr(extension, end - extension);
  return message;
}

std::string pack(const Message& message) {
  BigEndianWriter extension;
  std::string after;
  if (message.version >= 2) {
    auto [index, data] = pack_meta(message.meta);
    extension.put(static_cast<std::uint16_t>(kExtensionSize));
    extension.put(static_cast<std::uint16_t>(index.size()));
    extension.put(static_cast<std::uint32_t>(data.size()));
    extension.put(message.id);
    after = std::move(index) + data;
  }
  const std::string& before = extension.bytes();
  BigEndianWriter out;
  out.bytes().reserve(kHeaderSize + before.size() + message.content.size() + after.size());
  out.put(static_cast<std::uint16_t>(message.version >= 2 ? 2 : 1));
  out.put_padded(message.type, kTypeSize);
  out.put_padded(message.device, kNameSize);
  out.put(message.time);
  out.put(static_cast<std::uint64_t>(before.size() + message.content.size() + after.size()));
  out.put(checksum(after, checksum(message.content, checksum(before))));
  out.put_bytes(before);
  out.put_bytes(message.content);
  out.put_bytes(after);
  return std::move(out.bytes());
}

std::uint64_t utc_time_now() noexcept {
  using namespace std::chrono;
  const auto since = system_clock::now().time_since_epoch();
  const auto ns = static_cast<std::uint64_t>(duration_cast<nanoseconds>(since).count());
  constexpr std::uint64_t kBillion = 1'000'000'000;
  return (ns / kBillion) << 32U | ((ns % kBillion) << 32U) / kBillion;
}

double seconds_of(std::uint64_t time) noexcept {
  return static_cast<double>(time) / 4294967296.0;
}

}  // namespace artus::igtl
