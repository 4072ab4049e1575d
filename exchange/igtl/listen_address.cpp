// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/igtl/listen_address.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <system_error>

#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace artus::igtl {
namespace {

std::string text_of(const ListenAddress& where) {
  return where.address + ":" + std::to_string(where.port);
}

}  // namespace

Result<ListenAddress> parse_address(std::string_view text, const std::string& flag) {
  const auto refuse = [&] {
    return fail(
        ErrorCode::malformed,
        "'" + std::string(text) + "' is not [address:]port, for example 18944 or 0.0.0.0:18944",
        flag);
  };
  ListenAddress where;
  const std::size_t colon = text.rfind(':');
  std::string_view port = text;
  if (colon != std::string_view::npos) {
    port = text.substr(colon + 1);
    std::string_view address = text.substr(0, colon);
    if (address.size() > 2 && address.front() == '[' && address.back() == ']')
      address = address.substr(1, address.size() - 2);
    else if (address.find(':') != std::string_view::npos)
      return refuse();
    if (address.empty()) return refuse();
    where.address = std::string(address);
  }
  constexpr int kLastPort = 65535;
  const auto read = std::from_chars(port.data(), port.data() + port.size(), where.port);
  if (read.ec != std::errc{} || read.ptr != port.data() + port.size() || where.port < 0 ||
      where.port > kLastPort)
    return refuse();
  return where;
}

Result<int> open_listener(const ListenAddress& where) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(where.port);
  const int why = getaddrinfo(where.address.c_str(), port.c_str(), &hints, &found);
  if (why != 0)
    return fail(ErrorCode::invalid, "cannot listen there: " + std::string(gai_strerror(why)),
                text_of(where));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> keep(found, &freeaddrinfo);
  const int socket =
      ::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, found->ai_protocol);
  const int on = 1;
  constexpr int kBacklog = 16;
  if (socket >= 0) setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (socket >= 0 && bind(socket, found->ai_addr, found->ai_addrlen) == 0 &&
      ::listen(socket, kBacklog) == 0)
    return socket;
  const int error = errno;
  if (socket >= 0) close(socket);
  return fail(error == EADDRINUSE ? ErrorCode::unreadable : ErrorCode::invalid,
              "cannot listen there: " + std::generic_category().message(error), text_of(where));
}

Result<int> open_connection(const ListenAddress& where, const std::function<bool()>& give_up) {
  const auto refuse = [&](const std::string& why) {
    return fail(ErrorCode::not_found, "cannot connect to " + text_of(where) + ": " + why);
  };
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(where.port);
  const int code = getaddrinfo(where.address.c_str(), port.c_str(), &hints, &found);
  if (code != 0) return refuse(gai_strerror(code));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> keep(found, &freeaddrinfo);
  std::string why = "no answer";
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
    const int socket = ::socket(at->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket < 0) continue;
    int error = connect(socket, at->ai_addr, at->ai_addrlen) == 0 ? 0 : errno;
    constexpr int kTurns = 20;  // of 100 ms
    for (int turn = 0; error == EINPROGRESS && turn < kTurns && !give_up(); ++turn) {
      pollfd waiting{socket, POLLOUT, 0};
      if (poll(&waiting, 1, 100) <= 0) continue;
      socklen_t size = sizeof error;
      getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
    }
    if (error == 0) return socket;
    close(socket);
    if (error != EINPROGRESS) why = std::generic_category().message(error);
  }
  return refuse(why);
}

int port_of(int socket) noexcept {
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&bound), &size) != 0) return 0;
  in_port_t port = 0;  // at the same place in IPv4 and IPv6
  std::memcpy(&port, reinterpret_cast<const char*>(&bound) + offsetof(sockaddr_in, sin_port),
              sizeof port);
  return ntohs(port);
}

}  // namespace artus::igtl
