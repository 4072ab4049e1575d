// SPDX-License-Identifier: AGPL-3.0-or-later
// Programs of others as they are: servers that artus connects to, trackers that speak TDATA, QTDATA
// and POSITION, readers that are slow, poses that flip.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/exchange/igtl/contents.h"
#include "artus/detail/exchange/igtl/server.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/remote_command.h"
#include "artus/detail/exchange/tracker_device.h"
#include "tests/exchange/igtl_client.h"

namespace artus {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

igtl::Message message_of(const char* type, const char* device, std::string content) {
  igtl::Message message;
  message.type = type;
  message.device = device;
  message.content = std::move(content);
  return message;
}

Pose tilted(double x) {
  return make_pose(Vec3(0.1 + x, 0.02, -0.3), Vec3(1, 2, 3), Vec3(1, 0, 0));
}

bool comes_true(const std::function<bool()>& wanted) {
  for (int i = 0; i < 5000 && !wanted(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return wanted();
}

TEST(IgtlContents, PlacesAndQuaternionsComeBack) {
  const igtl::Matrix sent = millimetres_of(tilted(0));
  const auto near = [&](const igtl::Matrix& got) {
    return (got - sent).cwiseAbs().maxCoeff() < 1e-4;  // single precision at 300 mm
  };
  const std::string position = igtl::pack_position(sent);
  EXPECT_TRUE(near(*igtl::parse_position(position)));
  EXPECT_TRUE(near(*igtl::parse_position(position.substr(0, 24))));  // without w
  EXPECT_EQ(igtl::parse_position(position.substr(0, 12))->leftCols<3>(),
            Eigen::Matrix3d::Identity());
  EXPECT_FALSE(igtl::parse_position(position.substr(0, 20)));
  for (const auto& tools : {*igtl::parse_tdata(igtl::pack_tdata({{"a", sent}, {"b", sent}})),
                            *igtl::parse_qtdata(igtl::pack_qtdata({{"a", sent}, {"b", sent}}))}) {
    ASSERT_EQ(tools.size(), 2U);
    EXPECT_EQ(tools[1].name, "b");
    EXPECT_TRUE(near(tools[1].matrix));
  }
  EXPECT_EQ(igtl::pack_start_tracking("TDATA", 20).size(), 36U);
  EXPECT_FALSE(igtl::parse_tdata("short"));
  std::string zero = igtl::pack_qtdata({{"a", sent}});
  std::fill(zero.begin() + 34, zero.end(), '\0');
  EXPECT_THAT(igtl::parse_qtdata(zero).error().message, HasSubstr("norm"));
}

TEST(TrackerInbox, TakesToolsAndPositionsAsItTakesTransforms) {
  const igtl::Matrix probe = ReferenceFrame().to_reference(tilted(0));
  const igtl::Matrix needle = ReferenceFrame().to_reference(tilted(0.05));
  for (const bool quaternions : {false, true}) {
    TrackerInbox inbox{TrackerCalibration(), TrackerInbox::Names()};
    const std::vector<igtl::TrackedTool> tools{{"ProbeToReference", probe}, {"Needle", needle}};
    ASSERT_TRUE(inbox.take(quaternions ? message_of("QTDATA", "t", igtl::pack_qtdata(tools))
                                       : message_of("TDATA", "t", igtl::pack_tdata(tools)),
                           5));
    EXPECT_THAT(inbox.take_notice(), IsEmpty());
    TrackedPoses poses;
    ASSERT_TRUE(inbox.load(poses));
    EXPECT_TRUE(to_pose(poses.X_WP).isApprox(tilted(0), 1e-5));
    EXPECT_TRUE(to_pose(poses.X_WN).isApprox(tilted(0.05), 1e-5));
  }
  TrackerInbox inbox{TrackerCalibration(), TrackerInbox::Names()};
  ASSERT_TRUE(
      inbox.take(message_of("POSITION", "NeedleToReference", igtl::pack_position(needle)), 7));
  TrackedPoses poses;
  ASSERT_TRUE(inbox.load(poses));
  EXPECT_TRUE(to_pose(poses.X_WN).isApprox(tilted(0.05), 1e-5));
}

TEST(TrackerInbox, SaysOnceWhichNamesNobodyAskedFor) {
  TrackerInbox inbox{TrackerCalibration(), TrackerInbox::Names()};
  const igtl::Matrix some = millimetres_of(tilted(0));
  const auto tools = message_of("TDATA", "t", igtl::pack_tdata({{"Wand", some}, {"Disk", some}}));
  ASSERT_TRUE(inbox.take(tools, 5));
  EXPECT_THAT(inbox.take_notice(), HasSubstr("TDATA Wand, Disk is not taken"));
  ASSERT_TRUE(inbox.take(tools, 6));
  EXPECT_THAT(inbox.take_notice(), IsEmpty());
}

TEST(TrackerInbox, TellsPosesThatFlipOrLeapAndNotThoseThatMove) {
  TrackerInbox inbox{TrackerCalibration(), TrackerInbox::Names()};
  std::int64_t now = 1'000'000'000;
  const auto send = [&](const Pose& X_JN) {
    now += 67'000'000;
    const auto sent =
        inbox.take(message_of("TRANSFORM", "NeedleToReference",
                              igtl::pack_transform(ReferenceFrame().to_reference(X_JN))),
                   now);
    EXPECT_TRUE(sent);
    return inbox.take_notice();
  };
  for (int i = 0; i < 10; ++i) EXPECT_THAT(send(tilted(0.005 * i)), IsEmpty());  // 75 mm/s
  Pose flipped = tilted(0.05);
  flipped.rotate(Eigen::AngleAxisd(3.0, Vec3::UnitX()));
  EXPECT_THAT(send(flipped), HasSubstr("NeedleToReference flipped"));
  EXPECT_THAT(send(tilted(0.05)), HasSubstr("2 such poses"));
  EXPECT_THAT(send(tilted(0.25)), IsEmpty());  // the third: told again at the fourth
  EXPECT_THAT(send(tilted(0.05)), HasSubstr("leapt 200 mm in 67 ms"));
  now += 1'000'000'000;  // not seen meanwhile: a hand may be anywhere
  EXPECT_THAT(send(tilted(0.4)), IsEmpty());
}

TEST(RemoteCommand, WithoutAnEndIsRefused) {
  for (const char* broken :
       {"<", "<Command Value=\"30", "<Command Value=\"30\"", "<Command Name='x>"}) {
    const auto command = remote_command_of({1, "Gain", 3, broken});
    ASSERT_FALSE(command) << broken;
    EXPECT_THAT(command.error().message, HasSubstr("has no end"));
  }
}

TEST(IgtlConnection, GoesOutToAServerAsksForToolsAndComesBackWhenItWasAway) {
  std::atomic<int> asked{0};
  const auto theirs_of = [&](int port) {
    igtl::Server::Options options;
    options.where.port = port;
    options.on_request = {"TDATA"};
    return igtl::Server::listen(options, [&](const igtl::Message& message) {
      if (message.type == "STATUS") ++asked;
      return std::vector<igtl::Message>();
    });
  };
  auto theirs = theirs_of(0);
  ASSERT_TRUE(theirs) << theirs.error().to_string();
  const int port = (*theirs)->port();
  igtl::Server::Options options;
  options.connect_to = igtl::ListenAddress{"127.0.0.1", port};
  std::atomic<int> tools{0};
  const auto ours = igtl::Server::listen(options, [&](const igtl::Message& message) {
    if (message.type == "TDATA") ++tools;
    return std::vector<igtl::Message>();
  });
  ASSERT_TRUE(ours) << ours.error().to_string();
  const auto send_tools = [&] {
    (*theirs)->publish(
        {message_of("TDATA", "t", igtl::pack_tdata({{"Needle", millimetres_of(tilted(0))}}))});
    return tools.load() > 0;
  };
  EXPECT_TRUE(comes_true(send_tools));  // it came because STT_TDATA was sent
  (*ours)->publish({message_of("STATUS", "artus", igtl::pack_status({}))});
  EXPECT_TRUE(comes_true([&] { return asked.load() > 0; }));
  theirs->reset();
  EXPECT_TRUE(comes_true([&] { return (*ours)->clients() == 0; }));
  theirs = theirs_of(port);
  ASSERT_TRUE(theirs) << theirs.error().to_string();
  tools = 0;
  EXPECT_TRUE(comes_true(send_tools));
}

TEST(IgtlConnection, SaysWhyNobodyIsThereAndEndsAtOnce) {
  igtl::Server::Options options;
  options.connect_to = igtl::ListenAddress{"127.0.0.1", 1};
  const auto ours = igtl::Server::listen(
      options, [](const igtl::Message&) { return std::vector<igtl::Message>(); });
  ASSERT_TRUE(ours);
  std::string told;
  EXPECT_TRUE(comes_true([&] {
    for (const std::string& notice : (*ours)->take_notices()) told += notice;
    return !told.empty();
  }));
  EXPECT_THAT(told, HasSubstr("cannot connect to 127.0.0.1:1"));
}

/// How old pictures are, in pictures, for a reader that takes one every `period_ms`.
std::vector<double> ages_of_pictures(int period_ms, int count) {
  igtl::Server::Options options;
  options.where.port = 0;
  auto server = igtl::Server::listen(
      options, [](const igtl::Message&) { return std::vector<igtl::Message>(); });
  EXPECT_TRUE(server);
  test::IgtlClient client((*server)->port());
  EXPECT_TRUE(comes_true([&] { return (*server)->clients() == 1; }));
  std::atomic<bool> stop{false};
  std::atomic<std::uint32_t> newest{0};
  std::thread camera([&] {
    while (!stop) {
      igtl::Message picture = message_of("IMAGE", "Image_Reference", std::string(200'000, 'g'));
      picture.version = 2;
      std::string pose = igtl::pack_transform(millimetres_of(tilted(0)));
      const std::uint32_t number = ++newest;
      std::copy_n(reinterpret_cast<const char*>(&number), sizeof number, picture.content.begin());
      (*server)->publish({picture, message_of("TRANSFORM", "ProbeToReference", pose)});
      std::this_thread::sleep_for(std::chrono::milliseconds(33));
    }
  });
  std::vector<double> ages;
  for (int i = 0; i < count; ++i) {
    const auto got = client.wait_for("IMAGE");
    if (!got) break;
    std::uint32_t number = 0;
    std::copy_n(got->content.begin(), sizeof number, reinterpret_cast<char*>(&number));
    ages.push_back(newest - number);
    if (period_ms > 0) std::this_thread::sleep_for(std::chrono::milliseconds(period_ms));
  }
  stop = true;
  camera.join();
  return ages;
}

TEST(IgtlReader, ASlowOneGetsTheNewestPicture) {
  const std::vector<double> ages = ages_of_pictures(200, 25);
  ASSERT_EQ(ages.size(), 25U);
  const double oldest = *std::max_element(ages.begin() + 5, ages.end());
  std::printf("a reader of 5 pictures a second: the oldest was %.0f ms old\n", 33 * oldest);
  EXPECT_LE(33 * oldest, 900);
}

TEST(IgtlReader, AQuickOneGetsEveryPicture) {
  const std::vector<double> ages = ages_of_pictures(0, 60);
  ASSERT_EQ(ages.size(), 60U);
  double sum = 0;
  for (const double age : ages) sum += age;
  EXPECT_LE(sum / 60, 1);  // late by none or one, on a machine that is shared
}

}  // namespace
}  // namespace artus
