// SPDX-License-Identifier: AGPL-3.0-or-later
// What a laboratory does to shared memory by accident, while both sides run: each line of the list
// is a test. A whole session on one side, the C client on the other.
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/session/session.h"
#include "artus/session/shared_memory_device.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

/// A session that serves names of its own, and a client.
class HostileMemory : public ::testing::Test {
 protected:
  void SetUp() override {
    auto device = SharedMemoryDevice::open(prefix_, {});
    ASSERT_TRUE(device) << device.error().to_string();
    Session::Options options;
    options.haptic_options = {};
    options.imaging_options = {};
    options.share_images = true;
    options.image_segment_prefix = prefix_;
    auto session = Session::start(test::make_layered_scene(), test::make_small_session(),
                                  std::move(*device), options);
    ASSERT_TRUE(session) << session.error().to_string();
    session_ = std::move(*session);
    ASSERT_EQ(artus_shm_open(&link_, prefix_.c_str()), 0);
  }
  void TearDown() override { artus_shm_close(&link_); }
  ~HostileMemory() override {
    session_.reset();
    for (const SegmentLayout& layout : {kPosLayout, kForceLayout, kImageLayout})
      SharedSegment::remove(prefix_, layout);
  }
  [[nodiscard]] std::string file(const char* name) const { return "/dev/shm/" + prefix_ + name; }

  /// One period of the device program; whether it is heard and answered.
  bool talk() {
    artus_shm_pos pos = artus_shm_pos_init();
    pos.sample = ++sample_;
    pos.present = ARTUS_SHM_NEEDLE | ARTUS_SHM_PROBE;
    pos.needle_position[2] = -10e-3;
    artus_shm_write_pos(&link_, &pos);
    test::sleep_us(1000);
    return artus_shm_read_force(&link_, &force_) == 1 && (force_.status & 0xffff0000U) == 0;
  }
  bool talk_until_answered() {
    for (int i = 0; i < 5000; ++i)
      if (talk()) return true;
    return false;
  }
  bool wait_for(const std::function<bool()>& condition) {
    for (int i = 0; i < 5000; ++i) {
      if (condition()) return true;
      test::sleep_us(1000);
    }
    return false;
  }
  [[nodiscard]] bool was_told(const std::string& what) const {
    for (const std::string& notice : session_->notices())
      if (notice.find(what) != std::string::npos) return true;
    return false;
  }
  [[nodiscard]] bool sees_image(artus_shm_screen& screen) {
    return wait_for([&] { return artus_shm_read_image(&screen, image_.get()) == 1; });
  }

  std::string prefix_ = "artus-hostile-" + std::to_string(getpid()) + "-";
  std::unique_ptr<Session> session_;
  artus_shm_link link_{};
  artus_shm_force force_{};
  std::unique_ptr<artus_shm_image> image_ = std::make_unique<artus_shm_image>();
  std::uint64_t sample_ = 0;
};

TEST_F(HostileMemory, APlungerThatCannotBeIsRefusedAndTheNextOneServed) {
  struct Wrong {
    std::uint32_t sign;
    double travel;
    double force;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::uint32_t kTravel = ARTUS_SHM_PLUNGER_TRAVEL;
  constexpr std::uint32_t kForce = ARTUS_SHM_PLUNGER_FORCE;
  const std::vector<Wrong> all{{kTravel, kNan, 0},       {kTravel, kInfinity, 0},
                               {kTravel, 1e300, 0},      {kTravel, -1e300, 0},
                               {kForce, 0, kNan},        {kForce, 0, -kInfinity},
                               {kForce, 0, 1e9},         {kForce, 0, -1e300},
                               {kTravel | kForce, 0, 0}, {kForce | 0x80000000U, 0, 5}};
  ASSERT_TRUE(talk_until_answered());
  const auto say = [&](const Wrong& wrong) {
    artus_shm_pos pos = artus_shm_pos_init();
    pos.sample = ++sample_;
    pos.present = ARTUS_SHM_NEEDLE | ARTUS_SHM_PROBE | wrong.sign;
    pos.needle_position[2] = -10e-3;
    pos.plunger_travel = wrong.travel;
    pos.plunger_force = wrong.force;
    artus_shm_write_pos(&link_, &pos);
    test::sleep_us(1000);
    if (artus_shm_read_force(&link_, &force_) != 1) return;
    for (const double v : {force_.force[0], force_.force[1], force_.force[2], force_.thumb_force,
                           force_.pressure, force_.flow, force_.given, force_.drawn, force_.travel})
      ASSERT_TRUE(std::isfinite(v));
    ASSERT_LE(std::abs(force_.thumb_force), SyringeCore::kMaxForce);
  };
  for (const Wrong& wrong : all) {
    for (int i = 0; i < 30; ++i) say(wrong);
    EXPECT_EQ(force_.given, 0) << wrong.travel << ' ' << wrong.force;
    EXPECT_NE(force_.status, 0U) << wrong.travel << ' ' << wrong.force;
    ASSERT_TRUE(talk_until_answered()) << "the next sample is served";
  }
  // In the air a syringe gives what is pushed, against nothing but the needle.
  for (int i = 0; i < 3000 && force_.given <= 0; ++i) say({kForce, 0, 15});
  EXPECT_GT(force_.given, 0);
  EXPECT_LT(force_.given, 5.1e-6);
  EXPECT_NEAR(force_.tip_pressure, 0, 1);
}

struct Spoiling {
  const char* name;
  const char* segment;
  void (*spoil)(const std::string& file);
};

void cut_to_nothing(const std::string& file) {
  ASSERT_EQ(truncate(file.c_str(), 0), 0);
}
void cut_to_ten_bytes(const std::string& file) {
  ASSERT_EQ(truncate(file.c_str(), 10), 0);
}
void remove_name(const std::string& file) {
  ASSERT_EQ(unlink(file.c_str()), 0);
}
void overwrite_head(const std::string& file) {
  const int written = open(file.c_str(), O_WRONLY | O_CLOEXEC);
  const std::string garbage(24, '\x5a');
  ASSERT_EQ(pwrite(written, garbage.data(), garbage.size(), 0), 24);
  close(written);
}

class SpoiledSegment : public HostileMemory, public ::testing::WithParamInterface<Spoiling> {};

TEST_P(SpoiledSegment, IsToldMadeAnewAndFoundByTheClient) {
  ASSERT_TRUE(talk_until_answered());
  const std::uint64_t before = session_->ticks();
  for (int round = 0; round < 3; ++round) {
    GetParam().spoil(file(GetParam().segment));
    // Whoever reads FORCE meanwhile gets nothing or a whole force.
    for (int i = 0; i < 30; ++i) {
      talk();
      for (const double f : force_.force) ASSERT_TRUE(std::isfinite(f));
    }
    const std::string name = prefix_ + GetParam().segment;
    ASSERT_TRUE(wait_for([&] { return was_told(name); }));
    for (int i = 0; i < 250; ++i) talk();  // the client looks every 100 ms
    ASSERT_TRUE(talk_until_answered()) << "round " << round;
    artus_shm_link second{};
    EXPECT_NE(artus_shm_open(&second, prefix_.c_str()), 0) << "POS keeps its one writer";
    EXPECT_EQ(errno, EBUSY);
  }
  EXPECT_GT(session_->ticks(), before);
  EXPECT_TRUE(was_told("recreated"));
}

TEST_P(SpoiledSegment, ImageIsFoundAgainToo) {
  artus_shm_screen screen{};
  ASSERT_TRUE(wait_for([&] { return artus_shm_open_image(&screen, prefix_.c_str()) == 0; }));
  ASSERT_TRUE(sees_image(screen));
  GetParam().spoil(file("IMAGE"));
  ASSERT_TRUE(wait_for([&] { return was_told(prefix_ + "IMAGE"); }));
  const std::uint64_t frames = session_->frames();
  ASSERT_TRUE(wait_for(
      [&] { return artus_shm_read_image(&screen, image_.get()) == 1 && image_->frame > frames; }));
  EXPECT_GT(image_->width, 0U);
  artus_shm_close_image(&screen);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SpoiledSegment,
                         ::testing::Values(Spoiling{"PosCutToNothing", "POS", cut_to_nothing},
                                           Spoiling{"PosCutToTenBytes", "POS", cut_to_ten_bytes},
                                           Spoiling{"PosRemoved", "POS", remove_name},
                                           Spoiling{"PosOverwritten", "POS", overwrite_head},
                                           Spoiling{"ForceCutToNothing", "FORCE", cut_to_nothing},
                                           Spoiling{"ForceCutToTenBytes", "FORCE",
                                                    cut_to_ten_bytes},
                                           Spoiling{"ForceRemoved", "FORCE", remove_name},
                                           Spoiling{"ForceOverwritten", "FORCE", overwrite_head}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST_F(HostileMemory, AllNamesRemovedAtOnceAreMadeAnew) {
  ASSERT_TRUE(talk_until_answered());
  for (const SegmentLayout& layout : {kPosLayout, kForceLayout, kImageLayout})
    SharedSegment::remove(prefix_, layout);
  ASSERT_TRUE(wait_for([&] { return was_told("IMAGE was removed"); }));
  EXPECT_TRUE(talk_until_answered());
}

TEST_F(HostileMemory, AClosingClientDoesNotBelieveTheSizeInTheHeader) {
  // What lies behind the mapping must survive: a page of ours right after it, as far as the system
  // puts it there, and the rest of this process.
  link_.pos.header->size = 0xfffff000U;
  link_.force.header->size = 0xfffff000U;
  artus_shm_close(&link_);
  ASSERT_EQ(link_.pos.header, nullptr);
  EXPECT_GT(session_->ticks() + 1, 0U);
  ASSERT_TRUE(wait_for([&] { return was_told("overwritten"); }));
  ASSERT_TRUE(wait_for([&] { return artus_shm_open(&link_, prefix_.c_str()) == 0; }));
  EXPECT_TRUE(talk_until_answered());
}

TEST_F(HostileMemory, TwoClientsNeverWriteAtOnceWhileArtusIsSilent) {
  // A client whose artus is silent looks for new segments again and again; POS stays its own.
  ASSERT_TRUE(talk_until_answered());
  session_.reset();  // removes the names
  auto force =
      SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::owner_writes);
  ASSERT_TRUE(force);
  for (int i = 0; i < 400; ++i) talk();  // it has made a POS of its own and looks every 100 ms
  std::atomic<int> intruders{0};
  std::thread other([&] {
    for (int i = 0; i < 20000; ++i) {
      artus_shm_link second{};
      if (artus_shm_open(&second, prefix_.c_str()) == 0) {
        ++intruders;
        artus_shm_close(&second);
      }
    }
  });
  for (int i = 0; i < 500; ++i) talk();
  other.join();
  EXPECT_EQ(intruders.load(), 0);
}

TEST_F(HostileMemory, AProgramThatStartsAgainMayCountFromOne) {
  sample_ = 1'000'000;
  ASSERT_TRUE(talk_until_answered());
  artus_shm_close(&link_);
  ASSERT_EQ(artus_shm_open(&link_, prefix_.c_str()), 0);
  sample_ = 0;
  EXPECT_TRUE(talk_until_answered());
  EXPECT_LT(sample_, 3000U);
}

TEST_F(HostileMemory, ImageGoesOnWhileFrozenAndWithoutAProbe) {
  artus_shm_screen screen{};  // no device program has ever spoken
  ASSERT_TRUE(wait_for([&] { return artus_shm_open_image(&screen, prefix_.c_str()) == 0; }));
  ASSERT_TRUE(sees_image(screen));
  session_->set_frozen(true);
  test::sleep_us(200'000);
  const std::uint64_t beat = screen.image.header->heartbeat;
  ASSERT_TRUE(wait_for([&] { return screen.image.header->heartbeat > beat + 3; }));
  const std::uint64_t frame = image_->frame;
  ASSERT_TRUE(sees_image(screen));
  EXPECT_GE(image_->frame, frame);
  artus_shm_close_image(&screen);
}

TEST(Prefix, IsCheckedAlikeOnBothSides) {
  for (const std::string& bad :
       {std::string("lab/"), std::string("../x"), std::string("a b"), std::string(64, 'x'),
        std::string("\xc3\xa4"), std::string("-\n")}) {
    artus_shm_link link{};
    EXPECT_EQ(artus_shm_open(&link, bad.c_str()), -1) << bad;
    EXPECT_EQ(errno, EINVAL) << bad;
    const auto segment = SharedSegment::open(bad, kPosLayout, SegmentAccess::owner_reads);
    ASSERT_FALSE(segment) << bad;
    EXPECT_EQ(segment.error().code, ErrorCode::invalid);
  }
  const std::string longest = std::string(50, 'x') + std::to_string(getpid()) + "-_.";
  artus_shm_link link{};
  ASSERT_EQ(artus_shm_open(&link, longest.c_str()), 0);
  EXPECT_TRUE(SharedSegment::open(longest, kPosLayout, SegmentAccess::observer));
  artus_shm_close(&link);
  SharedSegment::remove(longest, kPosLayout);
  SharedSegment::remove(longest, kForceLayout);
}

}  // namespace
}  // namespace artus
