// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "artus/core/result.h"
#include "artus/detail/exchange/igtl/message.h"
#include "artus/detail/exchange/igtl/stream_reader.h"

namespace artus::igtl {

/// A message that goes to many: packed once for each header version that somebody wants.
class SharedMessage {
 public:
  explicit SharedMessage(Message message) : message_(std::move(message)) {}
  [[nodiscard]] const Message& message() const noexcept { return message_; }
  [[nodiscard]] std::shared_ptr<const std::string> packed(int version);

 private:
  Message message_;
  std::shared_ptr<const std::string> packed_[2];  // NOLINT(*-avoid-c-arrays): header 1, header 2
};

/// One connection of a server. What waits to be sent is bounded: of each type and device name only
/// the newest message waits, answers wait in a short row. The thread of the server alone uses it.
class ClientLink {
 public:
  struct Limits {
    std::int64_t stall_ns = 10'000'000'000;  ///< without taking a byte of what waits
    std::size_t answers = 256;               ///< that wait
  };
  /// Takes over a connected socket that does not block. `largest`: see StreamReader.
  ClientLink(int socket, std::string peer, StreamReader::Largest largest, const Limits& limits);
  ~ClientLink();
  ClientLink(const ClientLink&) = delete;
  ClientLink& operator=(const ClientLink&) = delete;

  /// Reads what has come. Errors: those of StreamReader; not_found when the other side is gone.
  [[nodiscard]] Result<void> receive(const std::function<void(const Message&)>& on_message);
  /// Sends as much as the other side takes now. Errors: not_found (gone), failed (it stalls, or
  /// asks faster than it reads).
  [[nodiscard]] Result<void> send(std::int64_t now_ns);

  /// The newest of its type and device; one that waits and is older is dropped.
  void offer(const std::shared_ptr<SharedMessage>& message);
  /// Goes before what is offered. More answers than may wait: send() says so.
  void answer(Message message);
  /// Types that this client wants although not everybody gets them.
  [[nodiscard]] std::set<std::string>& subscriptions() noexcept { return subscriptions_; }
  [[nodiscard]] const std::set<std::string>& subscriptions() const noexcept {
    return subscriptions_;
  }

  [[nodiscard]] bool has_to_send() const noexcept {
    return sending_ || !answers_.empty() || !newest_.empty();
  }
  /// Whether a picture waits until the other side has read the one before: it is replaced by newer
  /// ones meanwhile, where the system would have kept it.
  [[nodiscard]] bool waits_for_reader() const noexcept { return waits_for_reader_; }
  [[nodiscard]] int socket() const noexcept { return socket_; }
  [[nodiscard]] const std::string& peer() const noexcept { return peer_; }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }
  [[nodiscard]] int version() const noexcept { return version_; }

 private:
  [[nodiscard]] bool take_next(std::int64_t now_ns);
  [[nodiscard]] bool reader_lags(std::int64_t now_ns);

  int socket_;
  std::string peer_;
  StreamReader reader_;
  Limits limits_;
  std::deque<std::shared_ptr<SharedMessage>> newest_;  // one of each type and device
  std::deque<std::string> answers_;
  std::shared_ptr<const std::string> sending_;
  std::size_t sent_ = 0;  // bytes of it
  std::set<std::string> subscriptions_;
  std::int64_t progress_ns_ = 0;  // when the last byte went, or nothing waited
  std::uint64_t dropped_ = 0;
  std::size_t largest_sent_ = 0;     // bytes of the largest picture
  std::uint32_t widest_window_ = 0;  // bytes that the other side was ever ready to take
  std::uint32_t window_ = 0;         // the same now
  std::int64_t picture_ns_ = 0;      // when the last picture was begun
  bool waits_for_reader_ = false;
  bool asks_too_fast_ = false;
  int version_ = 1;  // of the headers that it understands, as far as it has shown
};

}  // namespace artus::igtl
