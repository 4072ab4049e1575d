// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"

/// OpenIGTLink messages as bytes: header, header 2's extension and metadata. What a body means is
/// in contents.h.
namespace artus::igtl {

inline constexpr std::size_t kHeaderSize = 58;  ///< bytes
inline constexpr std::size_t kTypeSize = 12;    ///< bytes, the longest type
inline constexpr std::size_t kNameSize = 20;    ///< bytes, the longest device name
/// Bytes of the largest body that is believed: 640 x 480 pixels are 0.3 MB.
inline constexpr std::uint64_t kLargestBody = 64U << 20U;

/// What stands in front of every body.
struct Header {
  int version = 1;  ///< 1 or 2
  std::string type;
  std::string device;
  std::uint64_t time = 0;  ///< UTC, in units of 2^-32 s; 0: not said
  std::uint64_t body_size = 0;
  std::uint64_t checksum = 0;
};

/// A word about a message, in header 2 alone.
struct MetaEntry {
  std::string key;
  std::string value;
  std::uint16_t encoding = 3;  ///< MIBenum: 3 US-ASCII, 106 UTF-8
  friend bool operator==(const MetaEntry&, const MetaEntry&) = default;
};

/// One message whose body is still bytes.
struct Message {
  int version = 1;  ///< of the header: 1 or 2
  std::string type;
  std::string device;
  std::uint64_t time = 0;  ///< as Header::time
  std::uint32_t id = 0;    ///< header 2 alone
  std::string content;     ///< the body without header 2's extension and metadata
  std::vector<MetaEntry> meta;

  /// The value of the first entry with this key; empty when there is none.
  [[nodiscard]] std::string_view meta_value(std::string_view key) const noexcept;
};

/// A header's 58 bytes. Requires: exactly so many. Errors: unsupported (version above 2), malformed
/// (a type or name that is no text), invalid (a body above kLargestBody).
[[nodiscard]] Result<Header> parse_header(std::string_view bytes);

/// A whole message from its header and body. Errors: corrupt (length or checksum), malformed
/// (extension or metadata that do not fit into the body).
[[nodiscard]] Result<Message> unpack(const Header& header, std::string body);

/// The message as it is sent; header 1 leaves out `id` and `meta`. Types and names that are too
/// long are cut.
[[nodiscard]] std::string pack(const Message& message);

/// The realtime clock as Header::time.
[[nodiscard]] std::uint64_t utc_time_now() noexcept;
/// s since 1970.
[[nodiscard]] double seconds_of(std::uint64_t time) noexcept;

}  // namespace artus::igtl
