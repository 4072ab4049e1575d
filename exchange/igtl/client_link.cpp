// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/igtl/client_link.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

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

bool ClientLink::take_next() {
  sent_ = 0;
  if (!answers_.empty()) {
    sending_ = std::make_shared<const std::string>(std::move(answers_.front()));
    answers_.pop_front();
  } else if (!newest_.empty()) {
    sending_ = newest_.front()->packed(version_);
    newest_.pop_front();
  } else {
    sending_.reset();
  }
  return sending_ != nullptr;
}

Result<void> ClientLink::send(std::int64_t now_ns) {
  if (asks_too_fast_)
    return fail(ErrorCode::failed, "the client sends requests faster than it reads the answers");
  if (!has_to_send()) progress_ns_ = now_ns;
  while (sending_ || take_next()) {
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
