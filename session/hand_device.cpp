// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/hand_device.h"

#include <algorithm>
#include <cmath>

namespace artus {
PlainPose approach(const PlainPose& from, const PlainPose& to, const HandDevice::Limits& limits,
                   double dt) noexcept {
  const double ease = 1 - std::exp(-dt / limits.smoothing);
  double distance = 0;
  for (std::size_t i = 0; i < 3; ++i)
    distance = std::hypot(distance, to.position[i] - from.position[i]);
  const double angle = rotation_of(from).angularDistance(rotation_of(to));
  const double by_distance = distance > 0 ? std::min(ease, limits.speed * dt / distance) : ease;
  const double by_turn = angle > 0 ? std::min(ease, limits.turn * dt / angle) : ease;
  PlainPose next = blend(from, to, by_turn);
  const PlainPose moved = blend(from, to, by_distance);
  std::copy(std::begin(moved.position), std::end(moved.position), std::begin(next.position));
  return next;
}

HandDevice::HandDevice(const HandTarget& start, double period_s, const Limits& limits) noexcept
    : limits_(limits), period_(period_s), now_(start), wanted_(start) {
  target_.store(start);
}

DeviceSample HandDevice::read(std::int64_t now_ns) noexcept {
  HandTarget target;
  if (target_.load(target, 4)) wanted_ = target;
  if (wanted_.probe_jumps != now_.probe_jumps) {
    now_.probe_jumps = wanted_.probe_jumps;
    now_.X_WP = wanted_.X_WP;
  }
  now_.X_WN = approach(now_.X_WN, wanted_.X_WN, limits_, period_);
  now_.X_WP = approach(now_.X_WP, wanted_.X_WP, limits_, period_);
  sample_.X_WN = now_.X_WN;
  sample_.X_WP = now_.X_WP;
  sample_.time_ns = now_ns;
  ++sample_.number;
  sample_.buttons = wanted_.buttons;
  sample_.has_needle = wanted_.has_needle;
  sample_.has_probe = 1;
  sample_.plunger = wanted_.has_plunger != 0 ? PlungerSign::force : PlungerSign::none;
  sample_.plunger_force = wanted_.has_plunger != 0 ? wanted_.thumb_force : 0;
  sample_.state = connected_.load(std::memory_order_relaxed) ? PeerState::alive : PeerState::lost;
  return sample_;
}

void HandDevice::write(const DeviceFeedback& /*feedback*/) noexcept {
  // A mouse renders no force; the window shows it.
}

}  // namespace artus
