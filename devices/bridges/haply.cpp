// SPDX-License-Identifier: AGPL-3.0-or-later
// Inverse3 with VerseGrip by Haply's service, a WebSocket that its installer brings. Never run on
// hardware.
#include <chrono>
#include <cstdlib>

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include "driver.h"
#include "haply_messages.h"

namespace artus::bridge {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Socket = beast::websocket::stream<asio::ip::tcp::socket>;
using Clock = std::chrono::steady_clock;

/// A connection whose every step ends after a time, or when it is to stop.
class Connection {
 public:
  /// `port` of this machine. What is wrong, or empty.
  std::string open(const std::string& port) {
    beast::error_code error;
    asio::ip::tcp::resolver resolver(context_);
    const auto found = resolver.resolve("127.0.0.1", port, error);
    if (!error) asio::connect(socket_.next_layer(), found, error);
    if (error) return "Haply's service is not on port " + port + ": " + error.message();
    socket_.next_layer().set_option(asio::ip::tcp::no_delay(true), error);
    socket_.read_message_max(1U << 20U);
    const std::string why = finish(std::chrono::seconds(2), [this](auto done) {
      socket_.async_handshake("localhost", "/", std::move(done));
    });
    return why.empty() ? "" : "Haply's service does not answer: " + why;
  }
  /// The next message into `text`; what is wrong, or empty.
  std::string read(std::string& text, std::chrono::milliseconds most) {
    buffer_.clear();
    const std::string why = finish(most, [this](auto done) {
      socket_.async_read(
          buffer_, [done = std::move(done)](beast::error_code error, std::size_t) { done(error); });
    });
    if (why.empty()) text = beast::buffers_to_string(buffer_.data());
    return why;
  }
  std::string write(const std::string& text) {
    outgoing_ = text;
    return finish(std::chrono::milliseconds(200), [this](auto done) {
      socket_.async_write(
          asio::buffer(outgoing_),
          [done = std::move(done)](beast::error_code error, std::size_t) { done(error); });
    });
  }
  void close() {
    finish(std::chrono::milliseconds(200), [this](auto done) {
      socket_.async_close(beast::websocket::close_code::normal, std::move(done));
    });
  }

 private:
  /// Begins a step and waits for its end. A step that takes too long ends the connection.
  template <class Begin>
  std::string finish(std::chrono::milliseconds most, const Begin& begin) {
    bool done = false;
    beast::error_code result;
    begin([&](beast::error_code error) {
      result = error;
      done = true;
    });
    context_.restart();
    context_.run_for(most);
    if (!done) {
      beast::error_code ignored;
      socket_.next_layer().close(ignored);
      context_.restart();
      context_.run();
      return "silent for " + std::to_string(most.count()) + " ms";
    }
    return result ? result.message() : "";
  }

  asio::io_context context_{1};
  Socket socket_{context_};
  beast::flat_buffer buffer_;
  std::string outgoing_;
};

class HaplyDevice final : public Device {
 public:
  HaplyDevice(std::unique_ptr<Connection> connection, std::string wanted)
      : connection_(std::move(connection)), wanted_(std::move(wanted)) {}
  ~HaplyDevice() override { connection_->close(); }

  std::string run(const Tick& tick, const std::atomic<bool>& stop) override {
    constexpr std::chrono::milliseconds kSilent(200);
    constexpr int kMostFaults = 200;  // messages without the device
    int faults = 0;
    std::string text;
    while (!stop) {
      std::string why = connection_->read(text, kSilent);
      if (!why.empty()) return why;
      const bool sound = take_haply_message(text, wanted_, state_);
      faults = sound ? 0 : faults + 1;
      if (faults == kMostFaults) {
        send({});
        return "the service does not tell of it";
      }
      why = send(tick(state_.reading));  // zero where the reading is not sound
      if (!why.empty()) return why;
    }
    send({});
    return "";
  }

 private:
  std::string send(const Triple& force) {
    return connection_->write(haply_command(state_.id, force));
  }

  std::unique_ptr<Connection> connection_;
  std::string wanted_;
  HaplyState state_;
};

class HaplyDriver final : public Driver {
 public:
  std::unique_ptr<Device> open(const std::string& name, std::string& why) override {
    auto connection = std::make_unique<Connection>();
    why = connection->open(port());
    if (!why.empty()) return nullptr;
    return std::make_unique<HaplyDevice>(std::move(connection), name);
  }
  std::string describe() override {
    Connection connection;
    const std::string why = connection.open(port());
    std::string text;
    if (!why.empty()) return why;
    if (!connection.read(text, std::chrono::milliseconds(500)).empty())
      return "the service is silent";
    HaplyState state;
    take_haply_message(text, "", state);
    return state.id.empty() ? "the service sees no Inverse3" : "Inverse3 " + state.id;
  }
  [[nodiscard]] HandLimits limits() const override { return {8, 2}; }
  [[nodiscard]] Triple workspace() const override { return {200, 200, 200}; }
  [[nodiscard]] Turn axes() const override { return {1, 0, 0, 0, 1, 0, 0, 0, 1}; }
  [[nodiscard]] const char* maker() const override { return "Haply"; }

 private:
  /// Of the service; ARTUS_HAPLY_PORT where it was moved.
  static std::string port() {
    const char* moved = std::getenv("ARTUS_HAPLY_PORT");
    return moved != nullptr ? moved : "10001";
  }
};

}  // namespace
}  // namespace artus::bridge

int main(int argc, char** argv) {
  artus::bridge::HaplyDriver driver;
  return artus::bridge::run_program(argc, argv, driver);
}
