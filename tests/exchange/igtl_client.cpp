// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/exchange/igtl_client.h"

#include <chrono>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace artus::test {
namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

IgtlClient::IgtlClient(int port, int receive_buffer)
    : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)),
      reader_([](std::string_view) { return std::size_t{64U << 20U}; }) {
  if (receive_buffer > 0)
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(static_cast<std::uint16_t>(port));
  where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&where), sizeof where), 0);
}

IgtlClient::~IgtlClient() {
  close(socket_);
}

void IgtlClient::send(const std::string& bytes) const {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) return;
    sent += static_cast<std::size_t>(n);
  }
}

bool IgtlClient::read_more(double seconds) {
  pollfd waiting{socket_, POLLIN, 0};
  if (closed_ || seconds <= 0 || poll(&waiting, 1, static_cast<int>(1e3 * seconds) + 1) <= 0)
    return false;
  std::string bytes(1U << 16U, '\0');
  const ssize_t n = recv(socket_, bytes.data(), bytes.size(), 0);
  closed_ = n <= 0;
  if (closed_) return false;
  const auto taken =
      reader_.take({bytes.data(), static_cast<std::size_t>(n)},
                   [this](const igtl::Message& message) { waiting_.push_back(message); });
  EXPECT_TRUE(taken) << taken.error().to_string();
  return true;
}

std::optional<igtl::Message> IgtlClient::wait_for(
    const std::function<bool(const igtl::Message&)>& wanted, double seconds) {
  const double end = seconds_now() + seconds;
  do {
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      if (!wanted(waiting_[i])) continue;
      igtl::Message found = waiting_[i];
      waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      return found;
    }
    waiting_.clear();
  } while (read_more(end - seconds_now()));
  return std::nullopt;
}

bool IgtlClient::is_closed_within(double seconds) {
  const double end = seconds_now() + seconds;
  while (read_more(end - seconds_now())) waiting_.clear();
  return closed_;
}

}  // namespace artus::test
