// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/haptic_loop.h"

namespace artus {

HapticLoop::HapticLoop(Simulation& simulation, InputDevice& device, double rate_hz,
                       Seqlock<HapticSnapshot>& newest, const HapticTimes& times) noexcept
    : simulation_(simulation),
      device_(device),
      newest_(newest),
      times_(times),
      schedule_(rate_hz),
      watch_(schedule_.period_ns()) {}

HapticLoop::~HapticLoop() {
  DeviceFeedback last;  // zero force, whoever still listens
  last.status = SessionStatus::kStopped;
  last.time_ns = monotonic_ns();
  device_.write(last);
}

void HapticLoop::wait() noexcept {
  const std::int64_t late = schedule_.wait();
  times_.lateness.add_with_missed(late, schedule_.period_ns());
  too_late_ = watch_.step(late);
}

const HapticSnapshot& HapticLoop::step(std::uint32_t command) noexcept {
  TickInput input;
  input.device = device_.read(monotonic_ns());
  input.tick = ++tick_;
  input.command = too_late_ ? command | SessionCommand::kLate : command;
  const std::int64_t begin = monotonic_ns();
  const std::int64_t cpu_begin = thread_cpu_ns();
  const HapticSnapshot& out = simulation_.tick(input);
  DeviceFeedback feedback = out.feedback;
  feedback.time_ns = monotonic_ns();
  device_.write(feedback);
  newest_.store(out);
  times_.cpu.add(thread_cpu_ns() - cpu_begin);
  times_.compute.add(monotonic_ns() - begin);
  return out;
}

}  // namespace artus
