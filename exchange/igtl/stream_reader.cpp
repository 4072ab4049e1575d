// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/igtl/stream_reader.h"

#include <algorithm>
#include <utility>

namespace artus::igtl {

Result<void> StreamReader::take_header(std::string_view& bytes) {
  const std::size_t n = std::min(bytes.size(), kHeaderSize - buffer_.size());
  buffer_.append(bytes.substr(0, n));
  bytes.remove_prefix(n);
  if (buffer_.size() < kHeaderSize) return {};
  auto header = parse_header(buffer_);
  ARTUS_TRY(header);
  version_ = header->version;
  buffer_.clear();
  const std::size_t most = largest_(header->type);
  if (most == 0) {
    to_pass_over_ = header->body_size;
    ++passed_over_;
    return {};
  }
  if (header->body_size > most)
    return fail(ErrorCode::invalid, header->type + " with a body of " +
                                        std::to_string(header->body_size) + " bytes; at most " +
                                        std::to_string(most));
  header_ = std::move(*header);
  return {};
}

Result<void> StreamReader::take_body(std::string_view& bytes,
                                     const std::function<void(const Message&)>& on_message) {
  const std::size_t n = std::min<std::size_t>(bytes.size(), header_->body_size - buffer_.size());
  buffer_.append(bytes.substr(0, n));
  bytes.remove_prefix(n);
  if (buffer_.size() < header_->body_size) return {};
  const auto message = unpack(*header_, std::exchange(buffer_, {}));
  header_.reset();
  ARTUS_TRY(message);
  on_message(*message);
  return {};
}

Result<void> StreamReader::take(std::string_view bytes,
                                const std::function<void(const Message&)>& on_message) {
  while (!lost_) {
    const std::size_t over = std::min<std::size_t>(bytes.size(), to_pass_over_);
    bytes.remove_prefix(over);
    to_pass_over_ -= over;
    // A message without a body is whole as soon as its header is.
    if (bytes.empty() && !(header_ && header_->body_size == 0)) return {};
    auto taken = header_ ? take_body(bytes, on_message) : take_header(bytes);
    if (!taken) lost_ = std::move(taken).error();
  }
  return tl::unexpected<Error>(*lost_);
}

}  // namespace artus::igtl
