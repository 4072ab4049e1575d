// SPDX-License-Identifier: AGPL-3.0-or-later
// Haply's bridge against a stand-in of the maker's service: its WebSocket and its JSON.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <nlohmann/json.hpp>

#include "tests/bridges/bridge_fixture.h"

namespace artus {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using test::comes;

/// A service of one client at a time: it sends a state, waits for a command, sends the next. When
/// the client is gone the device is let go.
class Service {
 public:
  Service() : acceptor_(context_, {asio::ip::address_v4::loopback(), 0}) {
    thread_ = std::thread([this] { run(); });
  }
  ~Service() {
    stop = true;
    beast::error_code error;
    asio::ip::tcp::socket knock(context_);  // accept() returns
    knock.connect({asio::ip::address_v4::loopback(), acceptor_.local_endpoint().port()}, error);
    thread_.join();
  }
  [[nodiscard]] std::string port() const {
    return std::to_string(acceptor_.local_endpoint().port());
  }
  std::atomic<bool> stop{false};
  std::atomic<int> spoil{0};  ///< 1: half messages, 2: no device, 3: closes
  std::atomic<bool> press{false};
  std::atomic<double> up{0};
  std::atomic<std::uint64_t> commands{0};

 private:
  std::string state() {
    nlohmann::json message{
        {"inverse3",
         {{{"device_id", "0A1"},
           {"state", {{"cursor_position", {{"x", 0.01}, {"y", 0.02}, {"z", 0.03}}}}}}}},
        {"verse_grip",
         {{{"device_id", "9"},
           {"state",
            {{"orientation", {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 1}}},
             {"buttons", {{"a", false}, {"b", false}, {"c", press.load()}}}}}}}}};
    if (spoil == 2) message["inverse3"] = nlohmann::json::array();
    const std::string text = message.dump();
    return spoil == 1 ? text.substr(0, text.size() / 2) : text;
  }
  void serve(asio::ip::tcp::socket socket) {
    beast::websocket::stream<asio::ip::tcp::socket> stream(std::move(socket));
    beast::error_code error;
    stream.next_layer().set_option(asio::ip::tcp::no_delay(true), error);
    stream.accept(error);
    while (!error && !stop && spoil != 3) {
      stream.write(asio::buffer(state()), error);
      if (error) break;
      beast::flat_buffer buffer;
      stream.read(buffer, error);
      if (error) break;
      const auto command =
          nlohmann::json::parse(beast::buffers_to_string(buffer.data()), nullptr, false);
      up = command["inverse3"][0]["commands"]["set_cursor_force"]["values"]["z"].get<double>();
      ++commands;
      std::this_thread::sleep_for(std::chrono::microseconds(800));
    }
    up = 0;
  }
  void run() {
    while (!stop) {
      beast::error_code error;
      asio::ip::tcp::socket socket(context_);
      acceptor_.accept(socket, error);
      if (!error && !stop) serve(std::move(socket));
    }
  }

  asio::io_context context_;
  asio::ip::tcp::acceptor acceptor_;
  std::thread thread_;
};

class HaplyBridge : public testing::Test {
 protected:
  void SetUp() override {
    artus_ = test::start_artus(prefix_);
    service_ = std::make_unique<Service>();
    start();
  }
  void TearDown() override {
    if (bridge_ > 0) test::end_process(bridge_, SIGKILL);
    service_.reset();
    if (artus_ > 0) test::end_process(artus_, SIGKILL);
    for (const char* name : {"POS", "POS-PROBE", "FORCE", "IMAGE"})
      shm_unlink(("/" + prefix_ + name).c_str());
  }
  void start() {
    bridge_ = test::start_bridge("haply", {"0A1=needle", "--prefix", prefix_},
                                 {"ARTUS_HAPLY_PORT=" + service_->port()});
  }
  bool feels(double newton) {
    service_->press = true;
    const bool felt = comes([&] { return std::abs(service_->up - newton) < 0.01; });
    service_->press = false;
    return felt;
  }
  double ms_to_nothing() const {
    const std::int64_t begin = test::clock_ns();
    while (service_->up != 0 && test::clock_ns() - begin < 1'000'000'000)
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    return 1e-6 * static_cast<double>(test::clock_ns() - begin);
  }
  std::string prefix_ = "haply-test-" + std::to_string(getpid()) + "-";
  std::unique_ptr<Service> service_;
  pid_t artus_ = 0;
  pid_t bridge_ = 0;
};

TEST_F(HaplyBridge, FeelsAndEndsWithoutAForce) {
  ASSERT_TRUE(comes([&] { return service_->commands > 10; }));
  EXPECT_EQ(service_->up, 0);
  EXPECT_TRUE(feels(1));
  EXPECT_EQ(test::end_process(bridge_, SIGTERM), 0);
  bridge_ = 0;
  EXPECT_TRUE(comes([&] { return service_->up == 0; }));
}

TEST_F(HaplyBridge, KilledOnEitherSideThereIsNoForceWithin20Ms) {
  ASSERT_TRUE(feels(1));
  test::end_process(bridge_, SIGKILL);
  const double own = ms_to_nothing();
  start();
  ASSERT_TRUE(feels(1));
  test::end_process(artus_, SIGKILL);
  artus_ = 0;
  const double other = ms_to_nothing();
  std::printf("haply: no force %.1f ms after the bridge, %.1f ms after artus was killed\n", own,
              other);
  EXPECT_LT(own, 20);
  EXPECT_LT(other, 25);
}

TEST_F(HaplyBridge, HalfMessagesAndADeviceThatIsGoneAreNoForce) {
  for (const int spoil : {1, 2, 3}) {
    ASSERT_TRUE(feels(1)) << spoil;
    service_->spoil = spoil;
    EXPECT_LT(ms_to_nothing(), 100) << spoil;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(service_->up, 0);
    service_->spoil = 0;
  }
  EXPECT_TRUE(feels(1));
}

}  // namespace
}  // namespace artus
