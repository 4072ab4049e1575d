// SPDX-License-Identifier: AGPL-3.0-or-later
// Kills either side of the shared memory with SIGKILL at random moments. ARTUS_KILLS=1000 makes the
// long run; a few are enough for every day.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <functional>

#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/session/session.h"
#include "artus/session/shared_memory_device.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;  // ns
constexpr std::int64_t kPatience = 20'000;        // ms, on a busy machine

std::uint64_t kills() {
  const char* wanted = std::getenv("ARTUS_KILLS");
  return wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 15;
}

void sleep_us(std::int64_t us) {
  const timespec pause{us / 1'000'000, us % 1'000'000 * 1000};
  nanosleep(&pause, nullptr);
}

/// A process that runs `body` until it is killed.
class Victim {
 public:
  explicit Victim(const std::function<void()>& body) : pid_(fork()) {
    if (pid_ == 0) {
      body();
      _exit(0);
    }
  }
  ~Victim() { kill_now(); }
  Victim(const Victim&) = delete;
  Victim& operator=(const Victim&) = delete;
  void kill_now() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }

 private:
  pid_t pid_;
};

void run_engine(const std::string& prefix) {
  auto device = SharedMemoryDevice::open(prefix, {"outside"});
  if (!device) _exit(3);
  for (std::uint64_t tick = 1;; ++tick) {
    const std::int64_t now = monotonic_ns();
    const DeviceSample sample = (*device)->read(now);
    DeviceFeedback feedback;
    feedback.tick = tick;
    feedback.answers = sample.number;
    feedback.force[2] = -1.5;
    feedback.time_ns = monotonic_ns();
    (*device)->write(feedback);
    sleep_us(200);
  }
}

void run_device(const std::string& prefix) {
  artus_shm_link link;
  if (artus_shm_open(&link, prefix.c_str()) != 0) _exit(3);
  for (std::uint64_t i = 1;; ++i) {
    artus_shm_pos pos = artus_shm_pos_init();
    pos.sample = pos.time_ns;  // grows over restarts, too
    pos.present = ARTUS_SHM_NEEDLE;
    artus_shm_write_pos(&link, &pos);
    sleep_us(200);
  }
}

/// A whole session, as `artus serve` runs it, in flat layers.
void run_session(const std::string& prefix) {
  auto device = SharedMemoryDevice::open(prefix, {});
  if (!device) _exit(3);
  SessionParams params = test::make_small_session();
  params.image_rate = 10;
  auto session = Session::start(test::make_layered_scene(), params, std::move(*device), {});
  if (!session) _exit(4);
  for (;;) sleep_us(1'000'000);
}

/// The needle's depth of a hand that goes in and out again, twice a second, m.
double depth_at(std::int64_t now_ns) {
  const double phase = 1e-9 * static_cast<double>(now_ns % 500'000'000) / 0.5;
  return 12e-3 * std::cos(6.283185307179586 * phase) + 2e-3;
}

class Crash : public ::testing::Test {
 protected:
  ~Crash() override {
    SharedSegment::remove(prefix_, kPosLayout);
    SharedSegment::remove(prefix_, kForceLayout);
  }
  std::string prefix_ = "artus-crash-" + std::to_string(getpid()) + "-";
};

TEST_F(Crash, AKilledEngineLeavesNoForceAndItsSuccessorIsFelt) {
  artus_shm_link link;
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  std::int64_t oldest = 0;
  for (std::uint64_t i = 0; i < kills(); ++i) {
    Victim engine([this] { run_engine(prefix_); });
    artus_shm_force force;
    const std::int64_t limit = monotonic_ns() + kPatience * kMillisecond;
    while (artus_shm_read_force(&link, &force) == 0)
      ASSERT_LT(monotonic_ns(), limit) << "restart " << i << " was not felt";
    sleep_us(static_cast<std::int64_t>(5000 * uniform_noise(7, i)));
    engine.kill_now();
    while (artus_shm_read_force(&link, &force) == 1) {
      ASSERT_EQ(force.force[2], -1.5) << "torn";
      oldest = std::max(oldest, monotonic_ns() - static_cast<std::int64_t>(force.time_ns));
      ASSERT_LT(monotonic_ns(), limit) << "hangs on a dead engine";
    }
    EXPECT_EQ(force.force[2], 0);
  }
  // The client judges age when it is called; what passes between that and our clock is scheduling.
  RecordProperty("oldest_force_us", static_cast<int>(oldest / 1000));
  artus_shm_close(&link);
}

TEST_F(Crash, AKilledSessionLeavesNoForceBeyondTwentyMillisecondsAndItsSuccessorIsFelt) {
  artus_shm_link link;
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  artus_shm_force force;
  std::int64_t oldest = 0;
  std::uint64_t with_force = 0;
  const auto move = [&] {
    artus_shm_pos pos = artus_shm_pos_init();
    pos.sample = pos.time_ns;
    pos.present = ARTUS_SHM_NEEDLE | ARTUS_SHM_PROBE;
    pos.needle_position[2] = depth_at(static_cast<std::int64_t>(pos.time_ns));
    artus_shm_write_pos(&link, &pos);
    return artus_shm_read_force(&link, &force);
  };
  for (std::uint64_t i = 0; i < kills(); ++i) {
    Victim engine([this] { run_session(prefix_); });
    std::int64_t limit = monotonic_ns() + kPatience * kMillisecond;
    while (move() == 0 || (force.status & ARTUS_SHM_PEER_LOST) != 0) {
      ASSERT_LT(monotonic_ns(), limit) << "restart " << i << " was not felt";
      sleep_us(500);
    }
    // Some are killed while they start to push back, some in the middle of an injection.
    const std::int64_t death =
        monotonic_ns() + static_cast<std::int64_t>(8e8 * uniform_noise(11, i));
    double last = 0;
    while (monotonic_ns() < death) {
      if (move() == 1) last = std::hypot(force.force[0], force.force[1], force.force[2]);
      ASSERT_LT(last, 1e3);
      sleep_us(500);
    }
    if (last > 0.05) ++with_force;
    const std::int64_t killed = monotonic_ns();
    engine.kill_now();
    limit = killed + kPatience * kMillisecond;
    std::int64_t now = monotonic_ns();
    while (move() == 1) {
      oldest = std::max(oldest, now - static_cast<std::int64_t>(force.time_ns));
      ASSERT_LT(now, limit) << "hangs on a dead session";
      now = monotonic_ns();
    }
    EXPECT_EQ(force.force[2], 0);
  }
  RecordProperty("kills_with_force", static_cast<int>(with_force));
  RecordProperty("oldest_force_us", static_cast<int>(oldest / 1000));
  EXPECT_GT(with_force, 0U);
  EXPECT_LE(oldest, static_cast<std::int64_t>(ARTUS_SHM_STALE_NS))
      << "judged by the time at which the client was asked";
  artus_shm_close(&link);
}

TEST_F(Crash, AKilledDeviceIsLostWithinTwentyMillisecondsAndItsSuccessorIsHeard) {
  auto engine = SharedMemoryDevice::open(prefix_, {});
  ASSERT_TRUE(engine);
  for (std::uint64_t i = 0; i < kills(); ++i) {
    Victim device([this] { run_device(prefix_); });
    const std::int64_t limit = monotonic_ns() + kPatience * kMillisecond;
    while ((*engine)->read(monotonic_ns()).state != PeerState::alive)
      ASSERT_LT(monotonic_ns(), limit) << "restart " << i << " was not heard";
    sleep_us(static_cast<std::int64_t>(5000 * uniform_noise(8, i)));
    device.kill_now();
    for (;;) {
      const std::int64_t now = monotonic_ns();
      const DeviceSample sample = (*engine)->read(now);
      if (sample.state == PeerState::lost) break;
      if (sample.state == PeerState::alive) {
        ASSERT_LT(now - sample.time_ns, 2 * kPeerTimeout) << "stale pose";
      }
      ASSERT_LT(now, limit) << "hangs on a dead device";
    }
  }
}

TEST_F(Crash, BothSidesMayDieTogetherAndStartInAnyOrder) {
  for (std::uint64_t i = 0; i < kills(); ++i) {
    Victim first([this] { run_device(prefix_); });
    Victim second([this] { run_engine(prefix_); });
    sleep_us(static_cast<std::int64_t>(3000 * uniform_noise(9, i)));
    first.kill_now();
    second.kill_now();
    const auto pos =
        SharedChannel<artus_shm_pos>::open(prefix_, kPosLayout, SegmentAccess::owner_writes);
    ASSERT_TRUE(pos) << pos.error().to_string();
    const auto force =
        SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::owner_writes);
    ASSERT_TRUE(force) << force.error().to_string();
  }
}

}  // namespace
}  // namespace artus
