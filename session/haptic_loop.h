// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>

#include "artus/detail/session/session_histogram.h"
#include "artus/detail/session/session_thread.h"
#include "artus/detail/session/shm/seqlock.h"
#include "artus/simulation/simulation.h"

namespace artus {

/// Where a haptic loop's time goes; written by the loop's thread, read by any.
struct HapticTimes {
  LatencyHistogram& compute;   ///< from the pose that was read to the force that was published
  LatencyHistogram& cpu;       ///< the same in processor time: without what was taken from it
  LatencyHistogram& lateness;  ///< wake-up after its schedule; also for the ticks it delayed
};

/// The one haptic loop: device in, core, device out, snapshot published, in the calling thread and
/// on an absolute schedule. Whoever runs it says when it ends; the last thing that the device gets
/// is zero force.
class HapticLoop {
 public:
  /// All arguments outlive the loop. Requires: rate_hz > 0.
  HapticLoop(Simulation& simulation, InputDevice& device, double rate_hz,
             Seqlock<HapticSnapshot>& newest, const HapticTimes& times) noexcept;
  ~HapticLoop();
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  /// Sleeps until the next tick is due.
  void wait() noexcept;
  /// The tick. `command`: SessionCommand bits; kLate is added when too many ticks came late.
  ARTUS_REALTIME const HapticSnapshot& step(std::uint32_t command) noexcept;

  [[nodiscard]] std::uint64_t ticks() const noexcept { return tick_; }
  [[nodiscard]] std::uint64_t overruns() const noexcept { return schedule_.overruns(); }

 private:
  Simulation& simulation_;
  InputDevice& device_;
  Seqlock<HapticSnapshot>& newest_;
  HapticTimes times_;
  PeriodicSchedule schedule_;
  LateWatch watch_;
  bool too_late_ = false;
  std::uint64_t tick_ = 0;
};

}  // namespace artus
