// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/igtl/server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <exception>
#include <system_error>
#include <utility>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "artus/detail/exchange/igtl/contents.h"

namespace artus::igtl {
namespace {

constexpr int kPollMs = 500;  // between two looks at clients that stall
constexpr std::size_t kMaxNotices = 200;

std::int64_t now_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

std::int64_t thread_processor_ns() noexcept {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return t.tv_sec * 1'000'000'000 + t.tv_nsec;
}

std::string name_of(const sockaddr_storage& peer, socklen_t size) {
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  if (getnameinfo(reinterpret_cast<const sockaddr*>(&peer), size, host.data(), host.size(),
                  port.data(), port.size(), NI_NUMERICHOST | NI_NUMERICSERV) != 0)
    return "a client";
  return std::string(host.data()) + ":" + port.data();
}

/// The answer to STT_ and STP_.
Message started(const std::string& type, const std::string& device, bool can) {
  Message message;
  message.type = "RTS_" + type;
  message.device = device;
  message.time = utc_time_now();
  message.content.assign(1, can ? '\0' : '\1');
  return message;
}

}  // namespace

std::size_t largest_body(std::string_view type) noexcept {
  constexpr std::size_t kText = 256U << 10U;
  constexpr std::size_t kCommand = 1U << 20U;
  constexpr std::array<std::string_view, 7> kTaken{"TRANSFORM", "POSITION", "TDATA", "QTDATA",
                                                   "STRING",    "STATUS",   "SENSOR"};
  if (type == "COMMAND") return kCommand;
  const std::string_view prefix = type.substr(0, 4);
  const bool question = prefix == "GET_" || prefix == "STT_" || prefix == "STP_";
  const bool taken = std::find(kTaken.begin(), kTaken.end(), type) != kTaken.end();
  return question || taken ? kText : 0;
}

Server::Server(int listener, int waker, Options options, OnMessage on_message)
    : listener_(listener),
      waker_(waker),
      port_(port_of(listener)),
      options_(std::move(options)),
      on_message_(std::move(on_message)) {}

Result<std::unique_ptr<Server>> Server::listen(const Options& options, OnMessage on_message) {
  const auto listener = options.connect_to ? Result<int>(-1) : open_listener(options.where);
  ARTUS_TRY(listener);
  const int waker = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (waker < 0) {
    const int error = errno;
    if (*listener >= 0) close(*listener);
    return fail(ErrorCode::failed, std::generic_category().message(error));
  }
  std::unique_ptr<Server> server(new Server(*listener, waker, options, std::move(on_message)));
  server->thread_ = std::thread([running = server.get()] { running->run(); });
  return server;
}

Server::~Server() {
  stop_ = true;
  eventfd_write(waker_, 1);
  if (thread_.joinable()) thread_.join();
  if (listener_ >= 0) close(listener_);
  close(waker_);
}

void Server::publish(std::vector<Message> messages) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (Message& message : messages) {
      const auto same =
          std::find_if(published_.begin(), published_.end(), [&](const Message& waiting) {
            return waiting.type == message.type && waiting.device == message.device;
          });
      if (same == published_.end())
        published_.push_back(std::move(message));
      else
        *same = std::move(message);
    }
  }
  eventfd_write(waker_, 1);
}

std::vector<std::string> Server::take_notices() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(notices_, {});
}

void Server::tell(const std::string& notice) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (notice == last_notice_) return;
  last_notice_ = notice;
  if (notices_.size() == kMaxNotices) notices_.erase(notices_.begin());
  notices_.push_back("OpenIGTLink: " + notice);
}

bool Server::goes_to(const ClientLink& client, const std::string& type) const {
  const auto& asked = options_.on_request;
  if (std::find(asked.begin(), asked.end(), type) == asked.end()) return true;
  return client.subscriptions().count(type) != 0;
}

void Server::hand_out() {
  std::vector<Message> fresh;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    fresh = std::exchange(published_, {});
  }
  for (Message& message : fresh) {
    const auto shared = std::make_shared<SharedMessage>(std::move(message));
    for (const auto& link : links_) {
      if (!goes_to(*link, shared->message().type)) continue;
      const std::uint64_t before = link->dropped();
      link->offer(shared);
      dropped_ += link->dropped() - before;
    }
  }
}

void Server::accept_clients() {
  for (;;) {
    sockaddr_storage peer{};
    socklen_t size = sizeof peer;
    const int socket =
        accept4(listener_, reinterpret_cast<sockaddr*>(&peer), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket < 0) return;
    const std::string name = name_of(peer, size);
    if (links_.size() >= options_.max_clients) {
      close(socket);
      tell(name + " was refused: " + std::to_string(links_.size()) +
           " clients are connected already");
      continue;
    }
    add_client(socket, name);
    tell(name + " connected");
  }
}

void Server::add_client(int socket, const std::string& name) {
  const int on = 1;
  const int buffer = 1 << 20;  // bytes that the system keeps for a slow client
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &buffer, sizeof buffer);
  links_.push_back(std::make_unique<ClientLink>(socket, name, largest_body, options_.limits));
  n_clients_ = links_.size();
}

void Server::connect_out() {
  constexpr std::int64_t kAgain = 1'000'000'000;  // ns
  if (!options_.connect_to || !links_.empty() || now_ns() < next_try_ns_) return;
  const ListenAddress& where = *options_.connect_to;
  const auto socket = open_connection(where, [this] { return stop_.load(); });
  next_try_ns_ = now_ns() + kAgain;
  if (stop_) return;
  if (!socket) return tell(socket.error().message + "; it is tried again each second");
  const std::string name = where.address + ":" + std::to_string(where.port);
  add_client(*socket, name);
  tell("connected to " + name);
  for (const char* type : {"TDATA", "QTDATA"}) {
    Message ask;
    ask.type = std::string("STT_") + type;
    ask.device = "artus";
    ask.time = utc_time_now();
    ask.content = pack_start_tracking(type, 10);
    links_.back()->answer(std::move(ask));
  }
}

int Server::wait_ms() const {
  constexpr int kLook = 4;  // ms, at what a slow reader has taken
  constexpr int kTry = 100;
  for (const auto& link : links_)
    if (link->waits_for_reader()) return kLook;
  return options_.connect_to && links_.empty() ? kTry : kPollMs;
}

void Server::answer(ClientLink& client, const Message& message) {
  const std::string prefix = message.type.substr(0, 4);
  const std::string of = message.type.size() > 4 ? message.type.substr(4) : std::string();
  if (prefix == "STT_" || prefix == "STP_") {
    const auto& known = options_.on_request;
    const bool can = std::find(known.begin(), known.end(), of) != known.end();
    if (!can && prefix == "STT_")
      tell(client.peer() + " asked for " + of + ", which is not sent; TDATA, STRING, SENSOR are");
    if (can && prefix == "STT_") client.subscriptions().insert(of);
    if (prefix == "STP_") client.subscriptions().erase(of);
    client.answer(started(of, message.device, can));
    return;
  }
  for (Message& reply : on_message_(message)) client.answer(std::move(reply));
}

void Server::close_client(const ClientLink* client, const Error& why) {
  tell(client->peer() + " closed: " + why.message);
  const auto place = std::find_if(links_.begin(), links_.end(),
                                  [client](const auto& link) { return link.get() == client; });
  links_.erase(place);
  n_clients_ = links_.size();
}

void Server::serve(ClientLink& client, short events) {
  if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) {
    Result<void> sense;
    const auto received = client.receive([&](const Message& message) {
      if (sense) sense = check_form(message.type, message.content);
      if (sense) answer(client, message);
    });
    if (!received) return close_client(&client, received.error());
    if (!sense) return close_client(&client, sense.error());
  }
  if (const auto sent = client.send(now_ns()); !sent) close_client(&client, sent.error());
}

void Server::run() {
  std::vector<pollfd> waiting;
  while (!stop_) {
    waiting.assign({{listener_, POLLIN, 0}, {waker_, POLLIN, 0}});
    for (const auto& link : links_)
      waiting.push_back(
          {link->socket(),
           static_cast<short>(link->has_to_send() && !link->waits_for_reader() ? POLLIN | POLLOUT
                                                                               : POLLIN),
           0});
    processor_ns_ = thread_processor_ns();
    poll(waiting.data(), waiting.size(), wait_ms());
    eventfd_t count = 0;
    eventfd_read(waker_, &count);
    hand_out();
    std::vector<ClientLink*> now;  // those that were polled: serving one may close it
    for (const auto& link : links_) now.push_back(link.get());
    for (std::size_t i = 0; i < now.size(); ++i) {
      try {
        serve(*now[i], waiting[i + 2].revents);
      } catch (const std::exception& e) {
        close_client(now[i], Error{ErrorCode::failed, e.what(), {}});
      }
    }
    if ((waiting[0].revents & POLLIN) != 0) accept_clients();
    connect_out();
  }
}

}  // namespace artus::igtl
