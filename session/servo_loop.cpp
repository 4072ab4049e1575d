// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/servo_loop.h"

#include <algorithm>
#include <cmath>

#include "artus/core/noise.h"

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
  report.most_force = std::max(report.most_force, std::sqrt(square));
}

}  // namespace

void run_servo_loop(HapticCore& core, InputDevice& device, const ServoOptions& options,
                    const std::atomic<bool>& stop, Seqlock<HapticSnapshot>& newest,
                    ServoReport& report) {
  report.refused = request_from_system(options.wishes);
  measure_floor(options, stop, report.floor);
  PeriodicSchedule schedule(options.rate_hz);
  LateWatch watch(schedule.period_ns());
  const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(1e9 * options.seconds);
  std::uint64_t x = 1;
  for (std::uint64_t number = 1; !stop.load(std::memory_order_relaxed); ++number) {
    const std::int64_t late = schedule.wait();
    const std::int64_t woken = monotonic_ns();
    if (woken >= end) break;
    report.lateness.add_with_missed(late, schedule.period_ns());
    TickInput input;
    input.device = device.read(woken);
    input.tick = number;
    const std::int64_t begin = monotonic_ns();
    const std::int64_t cpu_begin = thread_cpu_ns();
    if (watch.step(late)) input.command |= SessionCommand::kLate;
    const HapticSnapshot& out = core.step(input);
    newest.store(out);
    report.cpu.add(thread_cpu_ns() - cpu_begin);
    report.compute.add(monotonic_ns() - begin);
    DeviceFeedback feedback = out.feedback;
    feedback.time_ns = monotonic_ns();
    device.write(feedback);
    count(out, report);
    const std::int64_t idle = monotonic_ns();
    x = work_fixed(x);
    if (x != 0) report.fixed.add(monotonic_ns() - idle);  // never zero: the work is not left out
  }
  report.overruns = schedule.overruns();
  DeviceFeedback last;  // zero force, whoever still listens
  last.status = SessionStatus::kStopped;
  last.time_ns = monotonic_ns();
  device.write(last);
}

}  // namespace artus
