// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/igtl/client_link.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>

#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace artus::igtl {
namespace {

bool would_block(int error) noexcept {
  return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

tl::unexpected<Error> gone(int error) {
  return fail(ErrorCode::not_found, error == 0 ? "the client closed the connection"
                                               : std::generic_category().message(error));
}

/// Bytes that the other side's system says it can still take; nullopt where the system does not
/// tell (Linux before 5.4).
std::optional<std::uint32_t> window_of(int socket) {
  constexpr std::size_t kPlace = 228;  // bytes, of tcpi_snd_wnd in Linux' struct tcp_info
  std::array<char, 256> info{};
  socklen_t size = info.size();
  std::uint32_t window = 0;
  if (getsockopt(socket, IPPROTO_TCP, TCP_INFO, info.data(), &size) != 0 ||
      size < kPlace + sizeof window)
    return std::nullopt;
  std::memcpy(&window, info.data() + kPlace, sizeof window);
  return window;
}

}  // namespace

std::shared_ptr<const std::string> SharedMessage::packed(int version) {
  std::shared_ptr<const std::string>& bytes = packed_[version == 2 ? 1 : 0];
  if (!bytes) {
    message_.version = version;
    bytes = std::make_shared<const std::string>(pack(message_));
  }
  return bytes;
}

ClientLink::ClientLink(int socket, std::string peer, StreamReader::Largest largest,
                       const Limits& limits)
    : socket_(socket), peer_(std::move(peer)), reader_(std::move(largest)), limits_(limits) {}

ClientLink::~ClientLink() {
  close(socket_);
}

Result<void> ClientLink::receive(const std::function<void(const Message&)>& on_message) {
  std::array<char, 65536> bytes;  // NOLINT(*-member-init): written by recv
  const auto on_known = [&](const Message& message) {
    version_ = std::max(version_, message.version);  // before it is answered
    on_message(message);
  };
  constexpr int kTurns = 16;  // so that one who sends much does not keep the others waiting
  for (int turn = 0; turn < kTurns; ++turn) {
    const ssize_t n = recv(socket_, bytes.data(), bytes.size(), 0);
    if (n < 0 && would_block(errno)) return {};
    if (n <= 0) return gone(n == 0 ? 0 : errno);
    ARTUS_TRY(reader_.take({bytes.data(), static_cast<std::size_t>(n)}, on_known));
    version_ = std::max(version_, reader_.version());
  }
  return {};
}

bool ClientLink::reader_lags(std::int64_t now_ns) {
  constexpr std::int64_t kAtMost = 1'000'000'000;  // ns; whatever the system says of the other side
  if (largest_sent_ == 0 || now_ns - picture_ns_ > kAtMost) return false;
  int unacknowledged = 0;
  if (ioctl(socket_, SIOCOUTQ, &unacknowledged) != 0) return false;
  const auto held = static_cast<std::size_t>(unacknowledged);
  const std::optional<std::uint32_t> window = window_of(socket_);
  if (!window) return held > largest_sent_;
  if (*window > window_) progress_ns_ = now_ns;  // it has read
  window_ = *window;
  widest_window_ = std::max(widest_window_, window_);
  return held + widest_window_ - window_ > largest_sent_;
}

bool ClientLink::take_next(std::int64_t now_ns) {
  sent_ = 0;
  waits_for_reader_ = false;
  if (!answers_.empty()) {
    sending_ = std::make_shared<const std::string>(std::move(answers_.front()));
    answers_.pop_front();
  } else if (!newest_.empty()) {
    const auto is_picture = [](const auto& waiting) {
      return waiting->message().type == "IMAGE";
    };
    auto next = newest_.begin();
    if (is_picture(*next) && reader_lags(now_ns)) {
      waits_for_reader_ = true;
      next = std::find_if_not(newest_.begin(), newest_.end(), is_picture);
      if (next == newest_.end()) {
        sending_.reset();
        return false;
      }
    }
    sending_ = (*next)->packed(version_);
    if (is_picture(*next)) {
      picture_ns_ = now_ns;
      largest_sent_ = std::max(largest_sent_, sending_->size());
    }
    newest_.erase(next);
  } else {
    sending_.reset();
  }
  return sending_ != nullptr;
}

Result<void> ClientLink::send(std::int64_t now_ns) {
  if (asks_too_fast_)
    return fail(ErrorCode::failed, "the client sends requests faster than it reads the answers");
  if (!has_to_send()) progress_ns_ = now_ns;
  while (sending_ || take_next(now_ns)) {
    const ssize_t n =
        ::send(socket_, sending_->data() + sent_, sending_->size() - sent_, MSG_NOSIGNAL);
    if (n < 0 && !would_block(errno)) return gone(errno);
    if (n < 0) break;
    progress_ns_ = now_ns;
    sent_ += static_cast<std::size_t>(n);
    if (sent_ == sending_->size()) sending_.reset();
  }
  if (has_to_send() && now_ns - progress_ns_ > limits_.stall_ns)
    return fail(ErrorCode::failed, "the client does not read what is sent to it");
  return {};
}

void ClientLink::offer(const std::shared_ptr<SharedMessage>& message) {
  const auto same = std::find_if(newest_.begin(), newest_.end(), [&](const auto& waiting) {
    return waiting->message().type == message->message().type &&
           waiting->message().device == message->message().device;
  });
  if (same == newest_.end()) {
    newest_.push_back(message);
    return;
  }
  *same = message;
  ++dropped_;
}

void ClientLink::answer(Message message) {
  if (answers_.size() >= limits_.answers) {
    asks_too_fast_ = true;
    return;
  }
  message.version = version_;
  answers_.push_back(pack(message));
}

}  // namespace artus::igtl
