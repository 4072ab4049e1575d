// SPDX-License-Identifier: AGPL-3.0-or-later
// A whole session over its shared memory: what a peer that is silent, hostile or dead does to it.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <thread>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/session/session.h"
#include "artus/session/shared_memory_device.h"
#include "tests/session/session_support.h"
#include "tests/support/no_alloc.h"

namespace artus {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;  // ns

Session::Options plain_options() {
  Session::Options options;
  options.haptic_options = {};
  options.imaging_options = {};
  return options;
}

/// Passes everything on and counts the heap allocations of the haptic thread between two ticks.
class CountingDevice final : public InputDevice {
 public:
  static constexpr std::uint64_t kFirst = 50;
  static constexpr std::uint64_t kLast = 1500;
  CountingDevice(std::unique_ptr<InputDevice> inner, std::atomic<long>& result)
      : inner_(std::move(inner)), result_(result) {}

  DeviceSample read(std::int64_t now_ns) noexcept override {
    ++ticks_;
    if (ticks_ == kFirst) counter_.emplace();
    if (ticks_ == kLast) {
      result_ = counter_->count();
      counter_.reset();
    }
    return inner_->read(now_ns);
  }
  void write(const DeviceFeedback& feedback) noexcept override { inner_->write(feedback); }
  [[nodiscard]] std::string_view name() const noexcept override { return "counting"; }

 private:
  std::unique_ptr<InputDevice> inner_;
  std::atomic<long>& result_;
  std::optional<test::AllocationCounter> counter_;
  std::uint64_t ticks_ = 0;
};

TEST(SessionTick, DoesNotAllocate) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP() << "no allocation counter in this build";
  std::atomic<long> allocations{-1};
  auto hand = test::make_injecting_hand();
  Session::Options options = plain_options();
  options.recording =
      std::filesystem::temp_directory_path() / ("artus-alloc-" + std::to_string(getpid()) + ".rec");
  {
    const auto session =
        Session::start(test::make_layered_scene(), test::make_small_session(),
                       std::make_unique<CountingDevice>(std::move(hand), allocations), options);
    ASSERT_TRUE(session) << session.error().to_string();
    for (int i = 0; i < 2000 && allocations < 0; ++i) test::sleep_us(10'000);
  }
  std::filesystem::remove(options.recording);
  EXPECT_EQ(allocations, 0) << "from waking to sleeping, with a recorder and readers";
}

/// A session that serves names of its own.
class Border : public ::testing::Test {
 protected:
  void start() {
    auto device = SharedMemoryDevice::open(prefix_, {});
    ASSERT_TRUE(device) << device.error().to_string();
    auto session =
        Session::start(test::make_layered_scene(), params_, std::move(*device), plain_options());
    ASSERT_TRUE(session) << session.error().to_string();
    session_ = std::move(*session);
  }
  ~Border() override {
    session_.reset();
    SharedSegment::remove(prefix_, kPosLayout);
    SharedSegment::remove(prefix_, kForceLayout);
  }

  SessionParams params_ = test::make_small_session();
  std::unique_ptr<Session> session_;
  std::string prefix_ = "artus-border-" + std::to_string(getpid()) + "-";
};

artus_shm_pos pose_at(double z) {
  artus_shm_pos pos = artus_shm_pos_init();
  pos.present = ARTUS_SHM_NEEDLE | ARTUS_SHM_PROBE;
  pos.needle_position[2] = z;
  pos.probe_position[0] = 10e-3;
  return pos;
}

double norm_of(const artus_shm_force& force) {
  return std::hypot(force.force[0], force.force[1], force.force[2]);
}

TEST_F(Border, AHandThatFallsSilentInTheTissueFeelsNothingWithinTwentyMilliseconds) {
  start();
  artus_shm_link link;
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  artus_shm_force force{};
  std::int64_t longest = 0;
  int felt = 0;
  for (int round = 0; round < 3; ++round) {
    // In at 60 mm/s until muscle pushes back.
    std::uint64_t last_ns = 0;
    for (int i = 0; i < 600; ++i) {
      artus_shm_pos pos = pose_at(-10e-3 + 60e-6 * std::min(i, 400));
      pos.sample = pos.time_ns;
      last_ns = pos.time_ns;
      artus_shm_write_pos(&link, &pos);
      test::sleep_us(1000);
    }
    ASSERT_EQ(artus_shm_read_force(&link, &force), 1);
    if (norm_of(force) > 0.3) ++felt;
    // Silence: how old is the pose that the last force that is not zero answers?
    std::int64_t oldest = 0;
    for (int i = 0; i < 100; ++i) {
      if (artus_shm_read_force(&link, &force) == 1 && norm_of(force) > 0)
        oldest = std::max(oldest, static_cast<std::int64_t>(force.time_ns - last_ns));
      test::sleep_us(500);
    }
    longest = std::max(longest, oldest);
  }
  EXPECT_GT(felt, 0);
  EXPECT_LE(longest, 20 * kMillisecond);
  RecordProperty("longest_us", static_cast<int>(longest / 1000));
  artus_shm_close(&link);
}

/// What no client writes into the 200 bytes of POS, in turn with a sound sample.
void write_garbage(unsigned char* bytes, std::uint64_t i) {
  const double nasty[] = {std::numeric_limits<double>::quiet_NaN(),
                          std::numeric_limits<double>::infinity(),
                          1e308,
                          -1e-308,
                          5,
                          0};
  auto* head = reinterpret_cast<artus_shm_header*>(bytes);
  auto* pos = reinterpret_cast<artus_shm_pos*>(bytes + sizeof(artus_shm_header));
  switch (i % 4) {
    case 0:  // every byte, the head and the sequence, too
      for (std::size_t b = 0; b < 200; ++b)
        bytes[b] = static_cast<unsigned char>(mix_bits(i * 200 + b));
      break;
    case 1:  // a sound sequence over a head of another version and size
      head->magic = ARTUS_SHM_MAGIC_POS;
      head->version = static_cast<std::uint32_t>(mix_bits(i));
      head->size = static_cast<std::uint32_t>(mix_bits(i + 1));
      head->sequence = 2 * i;
      break;
    case 2: {  // a sound sample but for one number
      artus_shm_pos good = pose_at(10e-3 * static_cast<double>(i % 3));
      good.sample = i;
      good.needle_position[i % 3] = nasty[mix_bits(i) % 6];
      if (i % 3 == 0) good.needle_rotation[mix_bits(i) % 4] = nasty[mix_bits(i + 2) % 6];
      std::memcpy(pos, &good, sizeof good);
      head->sequence = 2 * i;
      break;
    }
    default: {  // a sound sample
      artus_shm_pos good = pose_at(12e-3);
      good.sample = i;
      std::memcpy(pos, &good, sizeof good);
      head->sequence = 2 * i;
      break;
    }
  }
}

TEST_F(Border, GarbageAllOverPosNeverGivesAForceThatIsNotFiniteOrOverTheLimit) {
  start();
  const std::string name = "/" + prefix_ + "POS";
  const int file = shm_open(name.c_str(), O_RDWR, 0600);
  ASSERT_GE(file, 0);
  auto* bytes =
      static_cast<unsigned char*>(mmap(nullptr, 200, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
  ASSERT_NE(bytes, MAP_FAILED);
  auto channel =
      SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::observer);
  ASSERT_TRUE(channel);
  std::uint64_t looked = 0;
  double most = 0;
  for (std::uint64_t i = 0; i < 6000; ++i) {
    write_garbage(bytes, i);
    artus_shm_force force{};
    if (channel->read(force)) {
      ++looked;
      for (const double f : force.force) ASSERT_TRUE(std::isfinite(f));
      for (const double t : force.torque) ASSERT_TRUE(std::isfinite(t));
      most = std::max(most, norm_of(force));
    }
    if (i % 4 == 3) test::sleep_us(400);
  }
  EXPECT_GT(looked, 1000U);
  EXPECT_LE(most, params_.device.force * (1 + 1e-12));
  munmap(bytes, 200);
  close(file);
  // And the session is still well: a good peer is felt again.
  artus_shm_link link;
  SharedSegment::remove(prefix_, kPosLayout);
  session_.reset();
  start();
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  artus_shm_force force{};
  bool alive = false;
  for (int i = 0; i < 3000 && !alive; ++i) {
    artus_shm_pos pos = pose_at(-10e-3);
    pos.sample = pos.time_ns;
    artus_shm_write_pos(&link, &pos);
    test::sleep_us(1000);
    alive = artus_shm_read_force(&link, &force) == 1 && (force.status & 0xffff0000U) == 0;
  }
  EXPECT_TRUE(alive);
  artus_shm_close(&link);
}

}  // namespace
}  // namespace artus
