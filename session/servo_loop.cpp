// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/servo_loop.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/noise.h"
#include "artus/detail/session/haptic_loop.h"

namespace artus {
namespace {

void measure_floor(const ServoOptions& options, const std::atomic<bool>& stop,
                   LatencyHistogram& floor) {
  PeriodicSchedule schedule(options.rate_hz);
  const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(1e9 * options.floor_seconds);
  while (monotonic_ns() < end && !stop.load(std::memory_order_relaxed))
    floor.add_with_missed(schedule.wait(), schedule.period_ns());
}

// A chain of dependent operations without memory: about as long as a tick.
std::uint64_t work_fixed(std::uint64_t x) noexcept {
  for (int i = 0; i < 1000; ++i) x = mix_bits(x);
  return x;
}

void count(const HapticSnapshot& out, ServoReport& report) noexcept {
  ++report.ticks;
  if ((out.status & TickStatus::kFaults & ~TickStatus::kLate) != 0) ++report.faults;
  if ((out.status & TickStatus::kLate) != 0) ++report.rested;
  if (out.inserted != 0) ++report.inserted;
  if (out.feedback.contact == static_cast<std::uint32_t>(ContactState::bone)) ++report.on_bone;
  const double square = out.force_J[0] * out.force_J[0] + out.force_J[1] * out.force_J[1] +
                        out.force_J[2] * out.force_J[2];
  report.max_thumb = std::max(report.max_thumb, std::abs(out.feedback.plunger.thumb_force));
  report.given = out.feedback.plunger.given;
  report.max_force = std::max(report.max_force, std::sqrt(square));
}

}  // namespace

void run_servo_loop(Simulation& simulation, InputDevice& device, const ServoOptions& options,
                    const std::atomic<bool>& stop, Seqlock<HapticSnapshot>& newest,
                    ServoReport& report) {
  report.refused = request_from_system(options.thread);
  measure_floor(options, stop, report.floor);
  const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(1e9 * options.seconds);
  HapticLoop loop(simulation, device, options.rate_hz, newest,
                  {report.compute, report.cpu, report.lateness});
  std::uint64_t x = 1;
  while (!stop.load(std::memory_order_relaxed) && monotonic_ns() < end) {
    loop.wait();
    count(loop.step(0), report);
    const std::int64_t idle = monotonic_ns();
    x = work_fixed(x);
    if (x != 0) report.fixed.add(monotonic_ns() - idle);  // never zero: the work is not left out
  }
  report.overruns = loop.overruns();
}

}  // namespace artus
