// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/operators/simulated_hand.h"
#include "artus/haptics/device.h"

namespace artus {

/// An impedance device with a hand on it: a mass with damping, force and torque limits, an encoder
/// step. The caller holds the motor's wrench over a haptic period (zero-order hold).
class SimulatedDevice {
 public:
  /// Requires: device.mass > 0. `inertia`: kg m^2 of all that turns; `hand_mass`: kg that moves
  /// along.
  SimulatedDevice(const DeviceLimits& device, double hand_mass, double inertia, const Pose& start);

  /// Advances by dt, s, with semi-implicit Euler; the motor is saturated first. `grip`: share of
  /// the hand's mass that moves along.
  void step(const Wrench& hand, const Wrench& motor, double dt, double grip = 1) noexcept;

  [[nodiscard]] const NeedleMotion& motion() const noexcept { return motion_; }
  /// What the encoders say: the position in steps; the orientation as it is.
  [[nodiscard]] Pose measured() const noexcept;

 private:
  DeviceLimits device_;
  double hand_mass_;
  double inertia_;
  NeedleMotion motion_;
  Eigen::Quaterniond orientation_;
};

}  // namespace artus
