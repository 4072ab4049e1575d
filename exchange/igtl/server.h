// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/exchange/igtl/client_link.h"
#include "artus/detail/exchange/igtl/listen_address.h"
#include "artus/detail/exchange/igtl/message.h"

namespace artus::igtl {

/// A server for any number of clients, in one thread of its own. Whoever publishes never waits for
/// a client; a client that lies or stalls is closed alone.
class Server {
 public:
  struct Options {
    ListenAddress where;
    ClientLink::Limits limits;
    std::size_t max_clients = 64;
    /// Types that only those get who asked with STT_ (and until STP_).
    std::vector<std::string> on_request{"STRING", "SENSOR", "TDATA"};
    /// Connects to a server of somebody else in place of listening (again each second while there
    /// is none), and asks it for TDATA and QTDATA, which trackers send only when asked.
    std::optional<ListenAddress> connect_to;
  };
  /// Called in the server's thread with each message that came whole; returns the answers.
  using OnMessage = std::function<std::vector<Message>(const Message&)>;

  /// Errors: as open_listener; none when it connects out.
  [[nodiscard]] static Result<std::unique_ptr<Server>> listen(const Options& options,
                                                              OnMessage on_message);
  /// Closes all connections.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Sends to everybody, from any thread, without waiting for anybody. A message that is still
  /// unsent when one of the same type and device follows is replaced by it.
  void publish(std::vector<Message> messages);

  [[nodiscard]] int port() const noexcept { return port_; }
  [[nodiscard]] std::size_t clients() const noexcept { return n_clients_; }
  /// Messages that were replaced before a client took them.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }
  /// Processor time of the server's thread so far, ns.
  [[nodiscard]] std::int64_t processor_ns() const noexcept { return processor_ns_; }
  /// Adds a notice, unless it is the same as the last.
  void tell(const std::string& notice);
  /// Who came, who went and why since the last call; for people.
  [[nodiscard]] std::vector<std::string> take_notices();

 private:
  Server(int listener, int waker, Options options, OnMessage on_message);
  void run();
  void accept_clients();
  void connect_out();
  void add_client(int socket, const std::string& name);
  [[nodiscard]] int wait_ms() const;
  void serve(ClientLink& client, short events);
  void answer(ClientLink& client, const Message& message);
  void close_client(const ClientLink* client, const Error& why);
  void hand_out();
  [[nodiscard]] bool goes_to(const ClientLink& client, const std::string& type) const;

  int listener_;  // -1: it connects out
  int waker_;
  int port_;
  Options options_;
  OnMessage on_message_;
  std::vector<std::unique_ptr<ClientLink>> links_;  // of the server's thread
  std::int64_t next_try_ns_ = 0;                    // to connect out
  std::mutex mutex_;                                // of the three below
  std::vector<Message> published_;
  std::vector<std::string> notices_;
  std::string last_notice_;
  std::atomic<bool> stop_{false};
  std::atomic<std::size_t> n_clients_{0};
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::int64_t> processor_ns_{0};
  std::thread thread_;
};

/// Bytes of the largest body that a server takes of a type; 0: passed over. Poses, texts, states,
/// commands and questions are wanted.
[[nodiscard]] std::size_t largest_body(std::string_view type) noexcept;

}  // namespace artus::igtl
