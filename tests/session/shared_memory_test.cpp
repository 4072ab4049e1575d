// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/shm/shared_memory.h"

#include <cstddef>
#include <fstream>
#include <memory>

#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/support/no_alloc.h"

namespace artus {
namespace {

using PosChannel = SharedChannel<artus_shm_pos>;

/// Names of their own for each test, gone afterwards.
class SharedMemory : public ::testing::Test {
 protected:
  ~SharedMemory() override {
    for (const SegmentLayout& layout : {kPosLayout, kForceLayout, kImageLayout})
      SharedSegment::remove(prefix_, layout);
  }
  [[nodiscard]] std::string file() const { return "/dev/shm/" + prefix_ + "POS"; }

  std::string prefix_ =
      "artus-test-" + std::to_string(getpid()) + "-" +
      std::to_string(::testing::UnitTest::GetInstance()->current_test_info()->line()) + "-";
};

TEST_F(SharedMemory, TheCClientReadsWhatTheEngineWrites) {
  auto force =
      SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::owner_writes);
  ASSERT_TRUE(force) << force.error().to_string();
  artus_shm_link link;
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  artus_shm_force sent{};
  sent.force[1] = -2.5;
  sent.time_ns = artus_shm_now_ns();
  force->write(sent);
  artus_shm_force got{};
  EXPECT_EQ(artus_shm_read_force(&link, &got), 1);
  EXPECT_EQ(got.force[1], -2.5);
  artus_shm_close(&link);
}

TEST_F(SharedMemory, TheEngineReadsWhatTheCClientWrites) {
  artus_shm_link link;
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  auto pos = PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_reads);
  ASSERT_TRUE(pos) << pos.error().to_string();
  artus_shm_pos sent = artus_shm_pos_init();
  sent.sample = 42;
  sent.probe_position[2] = 0.125;
  artus_shm_write_pos(&link, &sent);
  artus_shm_pos got{};
  ASSERT_TRUE(pos->read(got));
  EXPECT_EQ(got.sample, 42U);
  EXPECT_EQ(got.probe_position[2], 0.125);
  EXPECT_EQ(pos->segment().writer_pid(), static_cast<std::uint64_t>(getpid()));
  artus_shm_close(&link);
  EXPECT_EQ(pos->segment().writer_pid(), 0U);
}

TEST_F(SharedMemory, OnlyItsOwnerMayTouchASegment) {
  const auto pos = PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_reads);
  ASSERT_TRUE(pos);
  struct stat st {};
  ASSERT_EQ(stat(file().c_str(), &st), 0);
  EXPECT_EQ(st.st_mode & 0777U, 0600U);
  EXPECT_EQ(st.st_size, 224);
}

TEST_F(SharedMemory, ASecondWriterIsRefusedUntilTheFirstIsGone) {
  auto first = PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_writes);
  ASSERT_TRUE(first);
  const auto second = PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_writes);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::invalid);
  artus_shm_link link;
  EXPECT_NE(artus_shm_open(&link, prefix_.c_str()), 0);
  EXPECT_EQ(errno, EBUSY);
  first = fail(ErrorCode::failed, "closed");
  EXPECT_TRUE(PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_writes));
}

TEST_F(SharedMemory, AnObserverIsToldWhatIsMissing) {
  const auto none = PosChannel::open(prefix_, kPosLayout, SegmentAccess::observer);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::not_found);
}

TEST_F(SharedMemory, AClientOfAnotherVersionIsRefusedAndToldWhichSegment) {
  const auto make_old = [&](const SegmentLayout& layout, const char* name, std::uint32_t version) {
    artus_shm_header head{};
    head.magic = layout.magic;
    head.version = version;
    head.payload = layout.payload_size;
    std::string bytes(sizeof head + layout.payload_size, 0);
    head.size = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(bytes.data(), &head, sizeof head);
    const std::string path = "/dev/shm/" + prefix_ + name;
    std::ofstream(path, std::ios::binary) << bytes;
    chmod(path.c_str(), 0600);
  };
  artus_shm_link link;
  make_old(kForceLayout, "FORCE", ARTUS_SHM_VERSION - 1);
  EXPECT_EQ(artus_shm_open(&link, prefix_.c_str()), -1);
  EXPECT_EQ(errno, EPROTO);
  EXPECT_STREQ(link.refusal, "FORCE is of another version of artus' shared memory");
  make_old(kPosLayout, "POS", ARTUS_SHM_VERSION - 1);
  EXPECT_EQ(artus_shm_open(&link, prefix_.c_str()), -1);
  EXPECT_EQ(errno, EPROTO);
  EXPECT_STREQ(link.refusal, "POS is of another version of artus' shared memory");
  make_old(kForceLayout, "FORCE", ARTUS_SHM_VERSION);
  make_old(kPosLayout, "POS", ARTUS_SHM_VERSION);
  EXPECT_EQ(artus_shm_open(&link, prefix_.c_str()), 0) << "of this version the same bytes are good";
  artus_shm_close(&link);
}

struct LeftOver {
  const char* name;
  std::size_t size;
  std::uint64_t magic;
  std::uint32_t version;
  mode_t mode;
};

class LeftOverSegment : public SharedMemory, public ::testing::WithParamInterface<LeftOver> {
 protected:
  LeftOverSegment() {
    prefix_ = "artus-test-" + std::to_string(getpid()) + "-" + GetParam().name + "-";
    std::ofstream out(file(), std::ios::binary);
    const LeftOver& bad = GetParam();
    std::string bytes(bad.size, '\x5a');
    if (bad.size >= sizeof(artus_shm_header)) {
      artus_shm_header head{};
      head.magic = bad.magic;
      head.version = bad.version;
      head.size = static_cast<std::uint32_t>(bad.size);
      head.payload = sizeof(artus_shm_pos);
      std::memcpy(bytes.data(), &head, sizeof head);
    }
    out << bytes;
    out.close();
    chmod(file().c_str(), bad.mode);
  }
};

TEST_P(LeftOverSegment, IsReplacedByTheNextStartAndRefusedByAnObserver) {
  EXPECT_FALSE(PosChannel::open(prefix_, kPosLayout, SegmentAccess::observer));
  auto pos = PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_reads);
  ASSERT_TRUE(pos) << pos.error().to_string();
  artus_shm_pos zero = artus_shm_pos_init();
  ASSERT_TRUE(pos->read(zero));
  EXPECT_EQ(zero.sample, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, LeftOverSegment,
    ::testing::Values(LeftOver{"TooShort", 10, 0, 0, 0600},
                      LeftOver{"TooLong", 4096, ARTUS_SHM_MAGIC_POS, 1, 0600},
                      LeftOver{"WrongMagic", 200, 0x1234, 1, 0600},
                      LeftOver{"OtherVersion", 200, ARTUS_SHM_MAGIC_POS, 99, 0600},
                      LeftOver{"OpenToOthers", 200, ARTUS_SHM_MAGIC_POS, 1, 0666}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

TEST_F(SharedMemory, AGoodLeftOverIsUsedAgain) {
  {
    auto first = PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_writes);
    artus_shm_pos pos = artus_shm_pos_init();
    pos.sample = 9;
    first->write(pos);
  }
  const auto second = PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_reads);
  artus_shm_pos pos{};
  ASSERT_TRUE(second->read(pos));
  EXPECT_EQ(pos.sample, 9U);
}

TEST_F(SharedMemory, ARemovedOrResizedSegmentIsNoticed) {
  const auto pos = PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_reads);
  EXPECT_EQ(pos->segment().find_trouble(), nullptr);
  SharedSegment::remove(prefix_, kPosLayout);
  EXPECT_STREQ(pos->segment().find_trouble(), "was removed");
  const auto fresh = PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_reads);
  EXPECT_STREQ(pos->segment().find_trouble(), "was replaced");
  EXPECT_EQ(fresh->segment().find_trouble(), nullptr);
}

TEST_F(SharedMemory, AForceThatWasLeftBehindIsNeverFelt) {
  {
    auto crashed =
        SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::owner_writes);
    artus_shm_force force{};
    force.force[0] = 3;
    force.time_ns = artus_shm_now_ns();
    crashed->write(force);
  }
  artus_shm_link link;
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  artus_shm_force force{};
  EXPECT_EQ(artus_shm_read_force(&link, &force), 0);
  EXPECT_EQ(force.force[0], 0);
  EXPECT_EQ(force.status, static_cast<std::uint32_t>(ARTUS_SHM_SILENT));
  artus_shm_close(&link);
}

TEST_F(SharedMemory, ASilentForceBecomesZeroWithinTwentyMilliseconds) {
  auto channel =
      SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::owner_writes);
  artus_shm_link link;
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  artus_shm_force force{};
  force.force[0] = 3;
  force.time_ns = artus_shm_now_ns();
  channel->write(force);
  artus_shm_force felt{};
  while (artus_shm_read_force(&link, &felt) == 1) {
    ASSERT_LT(felt.time_ns + ARTUS_SHM_STALE_NS, artus_shm_now_ns() + ARTUS_SHM_STALE_NS + 1);
  }
  EXPECT_EQ(felt.force[0], 0);
  EXPECT_GE(artus_shm_now_ns() - force.time_ns, ARTUS_SHM_STALE_NS);
  artus_shm_close(&link);
}

TEST_F(SharedMemory, TheClientFindsTheSegmentsOfARestartedEngine) {
  artus_shm_link link;
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  SharedSegment::remove(prefix_, kPosLayout);
  SharedSegment::remove(prefix_, kForceLayout);
  auto channel =
      SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::owner_writes);
  const auto pos = PosChannel::open(prefix_, kPosLayout, SegmentAccess::owner_reads);
  artus_shm_force felt{};
  bool found = false;
  const std::uint64_t deadline = artus_shm_now_ns() + 10'000'000'000;
  while (!found && artus_shm_now_ns() < deadline) {
    artus_shm_force force{};
    force.time_ns = artus_shm_now_ns();
    channel->write(force);
    found = artus_shm_read_force(&link, &felt) == 1;
  }
  EXPECT_TRUE(found);
  artus_shm_close(&link);
}

TEST_F(SharedMemory, TicksOnItDoNotAllocate) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP() << "no allocation counter in this build";
  auto channel =
      SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::owner_writes);
  artus_shm_force force{};
  const test::AllocationCounter counter;
  channel->write(force);
  EXPECT_TRUE(channel->read(force));
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace artus
