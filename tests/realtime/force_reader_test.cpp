// SPDX-License-Identifier: AGPL-3.0-or-later
// A client that reads FORCE as fast as it can beside a writer at 10 kHz: does it ever get zero
// although the writer is well? ARTUS_FORCE_READS=10000000 makes the long run; ARTUS_FORCE_PACED
// reads at 10 kHz for so many seconds. The counts are printed.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/detail/session/session_thread.h"
#include "artus/detail/session/shm/shared_memory.h"

namespace artus {
namespace {

constexpr double kRate = 10'000;  // Hz
constexpr double kForce = -3;     // N

std::uint64_t wanted(const char* name, std::uint64_t usual) {
  const char* text = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): before threads start
  return text != nullptr ? std::strtoull(text, nullptr, 10) : usual;
}

/// Writes -3 N at 10 kHz and keeps when it last did.
class Writer {
 public:
  explicit Writer(SharedChannel<artus_shm_force>& channel) : channel_(channel) {
    thread_ = std::thread([this] { run(); });
  }
  ~Writer() {
    stop_ = true;
    thread_.join();
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  [[nodiscard]] std::int64_t last_ns() const noexcept { return last_ns_; }
  [[nodiscard]] std::uint64_t writes() const noexcept { return writes_; }

 private:
  void run() {
    PeriodicSchedule schedule(kRate);
    while (!stop_) {
      schedule.wait();
      artus_shm_force force{};
      force.tick = ++writes_;
      force.force[2] = kForce;
      force.time_ns = artus_shm_now_ns();
      channel_.write(force);
      last_ns_ = static_cast<std::int64_t>(force.time_ns);
    }
  }
  SharedChannel<artus_shm_force>& channel_;
  std::atomic<bool> stop_{false};
  std::atomic<std::int64_t> last_ns_{0};
  std::atomic<std::uint64_t> writes_{0};
  std::thread thread_;
};

struct Count {
  std::uint64_t reads = 0;
  std::uint64_t false_zeros = 0;  ///< zero although the writer had written within 20 ms
  std::uint64_t true_zeros = 0;   ///< zero since the writer itself was held up longer
  std::uint64_t untold = 0;       ///< zero when this reader was held up in the middle of the call
  std::uint64_t wrong = 0;        ///< neither zero nor what was written
};

class ForceReader : public ::testing::Test {
 protected:
  ~ForceReader() override {
    SharedSegment::remove(prefix_, kPosLayout);
    SharedSegment::remove(prefix_, kForceLayout);
  }
  void read_once(artus_shm_link& link, const Writer& writer, Count& count) {
    constexpr auto kStale = static_cast<std::int64_t>(ARTUS_SHM_STALE_NS);
    const std::int64_t before = monotonic_ns();
    const std::int64_t written = writer.last_ns();
    artus_shm_force force;
    const int fresh = artus_shm_read_force(&link, &force);
    ++count.reads;
    if (fresh == 1) {
      if (force.force[2] != kForce) ++count.wrong;
    } else if (monotonic_ns() - written < kStale) {
      ++count.false_zeros;
    } else {
      ++(before - written >= kStale ? count.true_zeros : count.untold);
    }
  }
  void print(const char* what, const Count& count, std::uint64_t writes) {
    std::printf(
        "%s: %llu reads beside %llu writes: %llu false zeros, %llu true, %llu untold, "
        "%llu wrong\n",
        what, static_cast<unsigned long long>(count.reads), static_cast<unsigned long long>(writes),
        static_cast<unsigned long long>(count.false_zeros),
        static_cast<unsigned long long>(count.true_zeros),
        static_cast<unsigned long long>(count.untold),
        static_cast<unsigned long long>(count.wrong));
  }
  std::string prefix_ = "artus-reads-" + std::to_string(getpid()) + "-";
};

TEST_F(ForceReader, NeverGetsZeroFromAWriterThatIsWell) {
  auto channel =
      SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::owner_writes);
  ASSERT_TRUE(channel);
  artus_shm_link link;
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  Count fast;
  Count paced;
  const Writer writer(*channel);
  artus_shm_force force;
  const std::int64_t patience = monotonic_ns() + 20'000'000'000;
  while (artus_shm_read_force(&link, &force) == 0) ASSERT_LT(monotonic_ns(), patience);
  const std::uint64_t reads = wanted("ARTUS_FORCE_READS", 300'000);
  while (fast.reads < reads) read_once(link, writer, fast);
  print("as fast as it can", fast, writer.writes());
  const std::uint64_t before = writer.writes();
  PeriodicSchedule schedule(kRate);
  const auto end =
      monotonic_ns() + static_cast<std::int64_t>(wanted("ARTUS_FORCE_PACED", 2)) * 1'000'000'000;
  while (monotonic_ns() < end) {
    schedule.wait();
    read_once(link, writer, paced);
  }
  print("at 10 kHz", paced, writer.writes() - before);
  EXPECT_EQ(fast.false_zeros + paced.false_zeros, 0U);
  EXPECT_EQ(fast.wrong + paced.wrong, 0U);
  artus_shm_close(&link);
}

}  // namespace
}  // namespace artus
