// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/exchange/igtl/message.h"

namespace artus::igtl {

/// Messages out of the bytes of one connection, which come in pieces of any size. Bodies that
/// nobody wants are passed over without being kept, so that the memory is bounded by the largest
/// wanted one and grows with what has really come, not with what a header says will come.
class StreamReader {
 public:
  /// `largest(type)`: bytes of the largest body that a wanted type may have; 0: pass it over.
  using Largest = std::function<std::size_t(std::string_view type)>;
  explicit StreamReader(Largest largest) : largest_(std::move(largest)) {}

  /// Takes all of `bytes` and calls `on_message` for each message that is now whole.
  /// Errors: those of parse_header and unpack, and invalid (a wanted type with a larger body); then
  /// the stream is lost and further bytes give the same error.
  [[nodiscard]] Result<void> take(std::string_view bytes,
                                  const std::function<void(const Message&)>& on_message);

  /// Bytes that are kept now.
  [[nodiscard]] std::size_t kept() const noexcept { return buffer_.capacity(); }
  /// Bodies that were passed over.
  [[nodiscard]] std::uint64_t passed_over() const noexcept { return passed_over_; }
  /// Version of the newest header; 1 before the first.
  [[nodiscard]] int version() const noexcept { return version_; }

 private:
  [[nodiscard]] Result<void> take_header(std::string_view& bytes);
  [[nodiscard]] Result<void> take_body(std::string_view& bytes,
                                       const std::function<void(const Message&)>& on_message);

  Largest largest_;
  std::string buffer_;  // of the header, then of the body
  std::optional<Header> header_;
  std::optional<Error> lost_;
  std::uint64_t to_pass_over_ = 0;  // bytes
  std::uint64_t passed_over_ = 0;
  int version_ = 1;
};

}  // namespace artus::igtl
