// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>

#include "artus/detail/session/shm/seqlock.h"
#include "artus/simulation/input_device.h"

namespace artus {

/// What a hand with mouse and keyboard wants of needle and probe. Written by the window's thread.
struct HandTarget {
  PlainPose X_WN;
  PlainPose X_WP;
  std::uint32_t buttons = 0;
  std::uint32_t has_needle = 1;
  std::uint32_t probe_jumps = 0;  ///< when it changes, the probe is at X_WP at once
  double thumb_force = 0;         ///< N on the plunger, positive in
  std::uint32_t has_plunger = 0;  ///< 1: the thumb is on it
};

/// A hand that goes where it is told, no faster than a hand moves: mouse and keyboard, a gamepad,
/// or a script. The needle follows its target at a bounded speed and without jerks, so that a
/// mouse's jumps become motions that the force laws can render.
class HandDevice final : public InputDevice {
 public:
  struct Limits {
    double speed = 0.08;      ///< m/s of needle and probe. assumed: an unhurried hand
    double turn = 1.5;        ///< rad/s. assumed
    double smoothing = 0.04;  ///< s, time in which most of the way to the target is made
  };
  HandDevice(const HandTarget& start, double period_s, const Limits& limits) noexcept;
  HandDevice(const HandTarget& start, double period_s) noexcept
      : HandDevice(start, period_s, Limits{}) {}

  /// From one other thread.
  void set_target(const HandTarget& target) noexcept { target_.store(target); }
  /// A hand that is gone, as a device whose cable is pulled.
  void set_connected(bool connected) noexcept { connected_ = connected; }

  [[nodiscard]] ARTUS_REALTIME DeviceSample read(std::int64_t now_ns) noexcept override;
  ARTUS_REALTIME void write(const DeviceFeedback& feedback) noexcept override;
  [[nodiscard]] std::string_view name() const noexcept override { return "mouse and keyboard"; }

 private:
  Limits limits_;
  double period_;
  Seqlock<HandTarget> target_;
  std::atomic<bool> connected_{true};
  HandTarget now_;
  HandTarget wanted_;
  DeviceSample sample_;
};

/// One step of a pose towards another, bounded in speed.
[[nodiscard]] ARTUS_REALTIME PlainPose approach(const PlainPose& from, const PlainPose& to,
                                                const HandDevice::Limits& limits,
                                                double dt) noexcept;

}  // namespace artus
