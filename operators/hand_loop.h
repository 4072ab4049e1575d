// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>

#include "artus/detail/core/check.h"
#include "artus/detail/operators/simulated_device.h"
#include "artus/detail/operators/simulated_hand.h"

namespace artus {

struct LoopParams {
  double rate_hz = 1000;  ///< haptic ticks a second
  double physics_hz =
      20000;  ///< steps a second of hand and device, at least: a whole number a tick
};

/// Hand, device and force laws in a closed loop, so that forces really move the needle. The motor's
/// wrench is held for a haptic period; hand and device move in finer steps.
class HandLoop {
 public:
  /// Requires: rates above 0.
  HandLoop(const LoopParams& params, const DeviceLimits& device, const HandParams& hand,
           const Pose& start)
      : dt_(1 / params.rate_hz),
        steps_(std::max(1, static_cast<int>(std::ceil(params.physics_hz / params.rate_hz - 1e-9)))),
        hand_(hand),
        device_(device, hand.mass, hand.inertia, start) {
    ARTUS_REQUIRE(params.rate_hz > 0 && params.physics_hz > 0, "rates must be above 0 Hz");
  }

  [[nodiscard]] double time() const noexcept { return dt_ * static_cast<double>(ticks_); }
  [[nodiscard]] double period() const noexcept { return dt_; }
  [[nodiscard]] Pose measured() const noexcept { return device_.measured(); }
  [[nodiscard]] const NeedleMotion& motion() const noexcept { return device_.motion(); }
  [[nodiscard]] const Vec3& hand_force() const noexcept { return hand_force_; }
  /// J given by the motor to hand and device since the start: a passivity observer's sum.
  [[nodiscard]] double energy_to_hand() const noexcept { return energy_; }

  /// One haptic period with the motor's wrench held. `intend(t)` gives the hand's intention.
  template <class Intend>
  void advance(const Wrench& motor, Intend intend) {
    const double h = dt_ / steps_;
    const double start = time();
    const Vec3 before = device_.motion().X_JN.translation();
    for (int i = 0; i < steps_; ++i) {
      const double t = start + i * h;
      felt_ += h / hand_.params().reflex_time * (motor.force - felt_);
      Intention intention = intend(t);
      const double opened = h / hand_.params().release_time;
      grip_ = intention.grip ? std::min(1.0, grip_ + opened) : std::max(0.0, grip_ - opened);
      intention.grip = grip_ > 0;
      Wrench hand = hand_.wrench(t, intention, device_.motion(), felt_);
      hand.force *= grip_;
      hand.torque *= grip_;
      hand_force_ = hand.force;
      device_.step(hand, motor, h, grip_);
      energy_ += motor.torque.dot(device_.motion().angular_velocity) * h;
    }
    energy_ += motor.force.dot(device_.motion().X_JN.translation() - before);
    ++ticks_;
  }

 private:
  double dt_;
  int steps_;
  SimulatedHand hand_;
  SimulatedDevice device_;
  Vec3 hand_force_ = Vec3::Zero();
  Vec3 felt_ = Vec3::Zero();
  double energy_ = 0;
  double grip_ = 1;  // share of the hand on the needle
  long ticks_ = 0;
};

}  // namespace artus
