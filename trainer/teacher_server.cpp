// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/teacher_server.h"

#include <chrono>
#include <thread>
#include <utility>

#include <httplib.h>

#include "artus/detail/training/records.h"

namespace artus {
namespace {

constexpr std::size_t kLongestCommand = 4096;  // bytes

bool is_loopback(const std::string& address) {
  return address.rfind("127.", 0) == 0 || address == "::1" || address == "localhost";
}

/// "127.0.0.1" of "127.0.0.1:8090".
std::string host_of(const std::string& header) {
  const std::size_t colon = header.rfind(':');
  const bool has_port = colon != std::string::npos && header.find(']', colon) == std::string::npos;
  return has_port ? header.substr(0, colon) : header;
}

}  // namespace

class TeacherServer::Listener {
 public:
  Listener(TeacherBoard& board, Options options) : board_(board), options_(std::move(options)) {
    open_ = is_loopback(options_.address);
    if (!open_ && options_.token.empty()) options_.token = make_random_id();
    server_.set_payload_max_length(kLongestCommand);
    server_.set_pre_routing_handler(
        [this](const httplib::Request& request, httplib::Response& response) {
          response.set_header("Cache-Control", "no-store");
          response.set_header("X-Content-Type-Options", "nosniff");
          if (may_come(request)) return httplib::Server::HandlerResponse::Unhandled;
          response.status = 403;
          response.set_content(
              "the address needs ?token=..., which the trainer's program printed\n", "text/plain");
          return httplib::Server::HandlerResponse::Handled;
        });
    server_.Get("/", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(teacher_page(options_.language), "text/html; charset=utf-8");
    });
    server_.Get("/state", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(board_.state().dump(), "application/json");
    });
    server_.Get("/picture", [this](const httplib::Request&, httplib::Response& response) {
      const std::string picture = board_.picture();
      if (picture.empty())
        response.status = 404;
      else
        response.set_content(picture, "image/png");
    });
    server_.Post("/command", [this](const httplib::Request& request, httplib::Response& response) {
      obey(request, response);
    });
  }
  ~Listener() {
    server_.stop();
    if (thread_.joinable()) thread_.join();
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  Result<void> listen() {
    port_ = options_.port;
    if (options_.port == 0)
      port_ = server_.bind_to_any_port(options_.address);
    else if (!server_.bind_to_port(options_.address, options_.port))
      port_ = -1;
    if (port_ <= 0)
      return fail(ErrorCode::unreadable,
                  "cannot listen at " + options_.address + ":" + std::to_string(options_.port) +
                      ": another program does, or this machine has no such address",
                  "--teacher");
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    // Before it runs it cannot be stopped.
    while (!server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return {};
  }

  [[nodiscard]] int port() const noexcept { return port_; }
  [[nodiscard]] std::string link() const {
    const bool is_v6 = options_.address.find(':') != std::string::npos;
    const std::string host = is_v6 ? "[" + options_.address + "]" : options_.address;
    return "http://" + host + ":" + std::to_string(port_) + "/" +
           (options_.token.empty() ? "" : "?token=" + options_.token);
  }

 private:
  /// Who knows the token; without one, who asks this machine by its own name.
  [[nodiscard]] bool may_come(const httplib::Request& request) const {
    if (!options_.token.empty()) return request.get_param_value("token") == options_.token;
    const std::string host = host_of(request.get_header_value("Host"));
    return is_loopback(host) || host == "[::1]";
  }

  void obey(const httplib::Request& request, httplib::Response& response) {
    // A form of another page cannot send this type without asking first.
    if (request.get_header_value("Content-Type").rfind("application/json", 0) != 0) {
      response.status = 415;
      return;
    }
    auto command = parse_teacher_command(request.body);
    if (!command) {
      response.status = 400;
      response.set_content(command.error().message + "\n", "text/plain");
      return;
    }
    board_.ask(std::move(*command));
    response.set_content("{}", "application/json");
  }

  TeacherBoard& board_;
  Options options_;
  bool open_ = false;  // without a token
  int port_ = -1;
  httplib::Server server_;
  std::thread thread_;
};

TeacherServer::TeacherServer(std::unique_ptr<Listener> listener) : listener_(std::move(listener)) {}
TeacherServer::~TeacherServer() = default;

Result<std::unique_ptr<TeacherServer>> TeacherServer::open(TeacherBoard& board,
                                                           const Options& options) {
  auto listener = std::make_unique<Listener>(board, options);
  ARTUS_TRY(listener->listen());
  return std::unique_ptr<TeacherServer>(new TeacherServer(std::move(listener)));
}

int TeacherServer::port() const noexcept {
  return listener_->port();
}

std::string TeacherServer::link() const {
  return listener_->link();
}

}  // namespace artus
