// SPDX-License-Identifier: AGPL-3.0-or-later
// The server with clients on real sockets: what it sends, and what cannot hurt it.
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/exchange/igtl/big_endian.h"
#include "artus/detail/exchange/igtl/client_link.h"
#include "artus/detail/exchange/igtl/contents.h"
#include "artus/detail/exchange/igtl/listen_address.h"
#include "artus/detail/exchange/igtl/server.h"
#include "tests/exchange/igtl_client.h"

namespace artus {
namespace {

using test::IgtlClient;
using testing::Contains;
using testing::HasSubstr;

igtl::Message text_message(const std::string& text, const char* device = "Text") {
  igtl::Message message;
  message.type = "STATUS";
  message.device = device;
  message.content = igtl::pack_status({igtl::Status::kOk, 0, "None", text});
  return message;
}

igtl::Message picture(std::size_t bytes, std::uint32_t id) {
  igtl::Message message;
  message.type = "IMAGE";
  message.device = "Image_Reference";
  message.id = id;
  message.content.assign(bytes, 'g');
  return message;
}

std::string status_text(const igtl::Message& message) {
  return igtl::parse_status(message.content).value_or(igtl::Status{}).message;
}

void sleep_ms(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

class IgtlServer : public testing::Test {
 protected:
  void start(igtl::Server::Options options = {}) {
    options.where.port = 0;
    auto server = igtl::Server::listen(options, [](const igtl::Message& message) {
      igtl::Message echo = text_message("got " + message.type + " " + message.device);
      return std::vector<igtl::Message>{echo};
    });
    ASSERT_TRUE(server) << server.error().to_string();
    server_ = std::move(*server);
  }
  void wait_for_clients(std::size_t n) const {
    for (int i = 0; i < 5000 && server_->clients() != n; ++i) sleep_ms(1);
    ASSERT_EQ(server_->clients(), n);
  }
  std::string notices() {
    std::string all;
    for (const std::string& notice : server_->take_notices()) all += notice + "\n";
    return all;
  }
  std::unique_ptr<igtl::Server> server_;
};

TEST(ListenAddress, IsThisMachineUnlessSaidOtherwise) {
  EXPECT_EQ(igtl::parse_address("18944", "--igtl")->address, "127.0.0.1");
  EXPECT_EQ(igtl::parse_address("0.0.0.0:2000", "--igtl")->address, "0.0.0.0");
  EXPECT_EQ(igtl::parse_address("0.0.0.0:2000", "--igtl")->port, 2000);
  EXPECT_EQ(igtl::parse_address("[::1]:2000", "--igtl")->address, "::1");
  for (const char* bad : {"", "x", ":1", "70000", "-1", "1:2:3", "localhost:", "12 "})
    EXPECT_FALSE(igtl::parse_address(bad, "--igtl")) << bad;
}

TEST_F(IgtlServer, TakenPortIsRefusedWithTheReason) {
  start();
  igtl::Server::Options options;
  options.where.port = server_->port();
  const auto second = igtl::Server::listen(options, {});
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().to_string(), HasSubstr("Address already in use"));
}

TEST_F(IgtlServer, EverybodyGetsWhatIsPublished) {
  start();
  IgtlClient a(server_->port());
  IgtlClient b(server_->port());
  wait_for_clients(2);
  server_->publish({text_message("hello")});
  for (IgtlClient* client : {&a, &b}) {
    const auto got = client->wait_for("STATUS");
    ASSERT_TRUE(got);
    EXPECT_EQ(status_text(*got), "hello");
    EXPECT_EQ(got->version, 1);
  }
}

TEST_F(IgtlServer, SpeaksHeaderTwoToThoseWhoDo) {
  start();
  IgtlClient old(server_->port());
  IgtlClient young(server_->port());
  igtl::Message hello = text_message("hello", "Slicer");
  hello.version = 2;
  hello.id = 3;
  hello.meta = {{"Version", "5.6"}};
  young.send(hello);
  ASSERT_EQ(young.wait_for("STATUS")->version, 2);
  wait_for_clients(2);
  igtl::Message message = text_message("news");
  message.meta = {{"a", "b"}};
  server_->publish({message});
  EXPECT_EQ(old.wait_for("STATUS")->version, 1);
  EXPECT_EQ(young.wait_for("STATUS")->meta_value("a"), "b");
}

TEST_F(IgtlServer, SomeTypesAreForThoseWhoAsk) {
  start();
  IgtlClient asks(server_->port());
  IgtlClient other(server_->port());
  igtl::Message start_sensor;
  start_sensor.type = "STT_SENSOR";
  asks.send(start_sensor);
  const auto reply = asks.wait_for("RTS_SENSOR");
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->content, std::string(1, '\0'));
  wait_for_clients(2);
  igtl::Message sensor;
  sensor.type = "SENSOR";
  sensor.content = igtl::pack_sensor({igtl::kNewton, {1, 2, 3}});
  server_->publish({sensor, text_message("end")});
  EXPECT_TRUE(asks.wait_for("SENSOR"));
  EXPECT_EQ(other.wait_for([](const igtl::Message&) { return true; })->type, "STATUS");
  start_sensor.type = "STT_POLYDATA";
  asks.send(start_sensor);
  EXPECT_EQ(asks.wait_for("RTS_POLYDATA")->content, std::string(1, '\1'));
}

TEST_F(IgtlServer, TheNewestPictureWinsWhereAClientIsSlow) {
  start();
  IgtlClient slow(server_->port(), 4096);
  wait_for_clients(1);
  for (std::uint32_t i = 1; i <= 100; ++i) {
    server_->publish({picture(300'000, i), text_message(std::to_string(i))});
    sleep_ms(1);
  }
  EXPECT_GT(server_->dropped(), 10U);
  const auto last = slow.wait_for(
      [](const igtl::Message& m) { return m.type == "STATUS" && status_text(m) == "100"; });
  EXPECT_TRUE(last);
}

TEST_F(IgtlServer, AClientThatStallsIsClosedAlone) {
  igtl::Server::Options options;
  options.limits.stall_ns = 300'000'000;
  start(options);
  IgtlClient stalls(server_->port(), 4096);
  IgtlClient reads(server_->port());
  wait_for_clients(2);
  for (std::uint32_t i = 1; i <= 30; ++i) {
    server_->publish({picture(1'000'000, i)});
    ASSERT_TRUE(reads.wait_for("IMAGE"));
  }
  for (int i = 0; i < 3000 && server_->clients() == 2; ++i) sleep_ms(1);
  EXPECT_EQ(server_->clients(), 1U);
  EXPECT_THAT(notices(), HasSubstr("does not read what is sent"));
  server_->publish({text_message("on")});
  EXPECT_TRUE(reads.wait_for("STATUS"));
}

TEST_F(IgtlServer, AClientThatLiesIsClosedAlone) {
  start();
  IgtlClient honest(server_->port());
  std::string flipped = igtl::pack(text_message("x"));
  flipped.back() = 'y';
  igtl::BigEndianWriter huge;
  huge.put(std::uint64_t{1} << 60U);
  std::string too_large = igtl::pack(text_message("x"));
  too_large.replace(42, 8, huge.bytes());
  igtl::Message cut = text_message("x");
  cut.type = "TRANSFORM";
  cut.content.resize(47);
  for (const std::string& lie :
       {flipped, too_large, igtl::pack(cut), std::string(58, '\xFF'),
        std::string("GET / HTTP/1.1\r\nHost: x\r\n\r\n") + std::string(58, ' ')}) {
    IgtlClient liar(server_->port());
    liar.send(lie);
    EXPECT_TRUE(liar.is_closed_within(10));
  }
  honest.send(text_message("still here"));
  EXPECT_TRUE(honest.wait_for("STATUS"));
  const std::string told = notices();
  EXPECT_THAT(told, HasSubstr("at most 64 MiB"));
  EXPECT_THAT(told, HasSubstr("TRANSFORM: its length does not match its content"));
}

TEST_F(IgtlServer, OneWhoAsksFasterThanItReadsIsClosed) {
  start();
  IgtlClient asks(server_->port(), 4096);
  std::string many;
  for (int i = 0; i < 20'000; ++i) many += igtl::pack(text_message("x"));
  asks.send(many);
  EXPECT_TRUE(asks.is_closed_within(10));
}

TEST_F(IgtlServer, PassesOverPicturesThatAreSentToIt) {
  start();
  IgtlClient client(server_->port());
  client.send(picture(5'000'000, 1));
  client.send(text_message("x", "after"));
  EXPECT_EQ(status_text(*client.wait_for("STATUS")), "got STATUS after");
}

TEST_F(IgtlServer, MoreClientsThanThereIsRoomForAreTurnedAway) {
  igtl::Server::Options options;
  options.max_clients = 2;
  start(options);
  IgtlClient a(server_->port());
  IgtlClient b(server_->port());
  wait_for_clients(2);
  IgtlClient c(server_->port());
  EXPECT_TRUE(c.is_closed_within(10));
  EXPECT_EQ(server_->clients(), 2U);
}

TEST_F(IgtlServer, EndsWithClientsConnected) {
  start();
  IgtlClient client(server_->port());
  wait_for_clients(1);
  server_.reset();
  EXPECT_TRUE(client.is_closed_within(10));
}

}  // namespace
}  // namespace artus
