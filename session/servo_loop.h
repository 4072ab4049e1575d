// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "artus/detail/session/session_histogram.h"
#include "artus/detail/session/session_thread.h"
#include "artus/detail/session/shm/seqlock.h"
#include "artus/simulation/simulation.h"

namespace artus {

struct ServoOptions {
  double rate_hz = 1000;
  double seconds = 10;
  double floor_seconds = 1;  ///< of ticks that do nothing, before: what the machine itself is late
  ThreadOptions thread{80, 0, true, -1};
};

/// Where a run's time went, and what it met.
struct ServoReport {
  LatencyHistogram compute;   ///< one tick from the pose to the published force, clock time
  LatencyHistogram cpu;       ///< the same in processor time
  LatencyHistogram lateness;  ///< wake-up after its schedule; a late one also for those it delayed
  LatencyHistogram floor;     ///< the same for ticks that do nothing, before the run
  LatencyHistogram fixed;     ///< clock time of one fixed work after each tick: its spread is the
                              ///< machine's own (interrupts, a host that takes the processor)
  std::uint64_t ticks = 0;
  std::uint64_t overruns = 0;  ///< ticks late by a period or more
  std::uint64_t rested = 0;    ///< ticks with zero force since too many came late
  std::uint64_t faults = 0;    ///< ticks whose input was refused
  std::uint64_t inserted = 0;  ///< ticks with the needle in the body
  std::uint64_t on_bone = 0;
  double max_force = 0;              ///< N sent
  double max_thumb = 0;              ///< N sent to the plunger
  double given = 0;                  ///< m^3 out of the needle's tip
  std::vector<std::string> refused;  ///< what the system did not grant, in words
};

/// Runs haptic ticks in the calling thread on an absolute schedule until the time is over or
/// `stop`: device in, tick, device out, snapshot published; then, as a gauge of the machine, a
/// fixed work of some microseconds (ServoReport::fixed). The last thing sent is zero force. Asks
/// the system for `wishes` first; a refusal is reported, not fatal.
void run_servo_loop(Simulation& simulation, InputDevice& device, const ServoOptions& options,
                    const std::atomic<bool>& stop, Seqlock<HapticSnapshot>& newest,
                    ServoReport& report);

}  // namespace artus
