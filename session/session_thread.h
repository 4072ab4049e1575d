// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "artus/detail/core/check.h"

namespace artus {

/// Monotonic clock, ns.
[[nodiscard]] ARTUS_REALTIME std::int64_t monotonic_ns() noexcept;
/// Time that the calling thread has run on a processor, ns: what others took from it is not in it.
[[nodiscard]] ARTUS_REALTIME std::int64_t thread_cpu_ns() noexcept;

/// Wake-ups on an absolute schedule: a slow tick does not shift those after it. A tick that is late
/// by a period or more re-bases the schedule instead of being made up for in a burst.
class PeriodicSchedule {
 public:
  /// Requires: rate > 0 Hz.
  explicit PeriodicSchedule(double rate_hz) noexcept;
  /// Sleeps until the next tick is due; returns how late it woke, ns.
  std::int64_t wait() noexcept;
  [[nodiscard]] std::int64_t period_ns() const noexcept { return period_; }
  [[nodiscard]] std::uint64_t overruns() const noexcept { return overruns_; }

 private:
  std::int64_t period_;
  std::int64_t due_;
  std::uint64_t overruns_ = 0;
};

/// Says when ticks have come too late for too long: every one of them by a period or more, over a
/// time. A single late tick is felt as a moment's hold; a row of them is a loop that no longer
/// controls the device. Source: the practice of libfranka [Franka].
class LateWatch {
 public:
  static constexpr std::int64_t kTooLong = 20'000'000;  // ns; assumed: as for a stale input

  explicit LateWatch(std::int64_t period_ns) noexcept : period_(period_ns) {}

  /// `late_ns`: of this tick. Returns whether the force has to rest.
  ARTUS_REALTIME bool step(std::int64_t late_ns) noexcept {
    row_ = late_ns >= period_ ? row_ + period_ + late_ns / period_ * period_ : 0;
    return row_ > kTooLong;
  }

 private:
  std::int64_t period_;
  std::int64_t row_ = 0;  // ns of the present row of late ticks
};

/// What the system was asked for on behalf of the calling thread.
struct ThreadOptions {
  int fifo_priority = 0;  ///< SCHED_FIFO priority; 0: ordinary scheduling
  int nice = 0;           ///< -20 urgent .. 19 patient, for ordinary scheduling; 0: as it is
  bool lock_memory = false;
  int cpu = -1;  ///< the one processor to run on; -1: any
};

/// Asks and returns what was refused, in words; a refusal is no failure.
[[nodiscard]] std::vector<std::string> request_from_system(const ThreadOptions& options);

}  // namespace artus
