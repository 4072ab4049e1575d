// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/simulated_device.h"

#include "artus/detail/core/check.h"

namespace artus {

SimulatedDevice::SimulatedDevice(const DeviceLimits& device, double hand_mass, double inertia,
                                 const Pose& start)
    : device_(device),
      hand_mass_(hand_mass),
      inertia_(inertia),
      orientation_(Eigen::Quaterniond(start.linear()).normalized()) {
  ARTUS_REQUIRE(device.mass > 0 && inertia > 0, "a device has mass and inertia");
  motion_.X_JN = start;
}

void SimulatedDevice::step(const Wrench& hand, const Wrench& motor, double dt,
                           double grip) noexcept {
  const Wrench driven = saturate(device_, motor);
  const Vec3 force = hand.force + driven.force - device_.damping * motion_.velocity;
  motion_.velocity += dt / (device_.mass + grip * hand_mass_) * force;
  motion_.X_JN.translation() += dt * motion_.velocity;
  motion_.angular_velocity += dt / inertia_ * (hand.torque + driven.torque);
  const Vec3 half = 0.5 * dt * motion_.angular_velocity;
  orientation_ = (Eigen::Quaterniond(1, half.x(), half.y(), half.z()) * orientation_).normalized();
  motion_.X_JN.linear() = orientation_.toRotationMatrix();
}

Pose SimulatedDevice::measured() const noexcept {
  Pose pose = motion_.X_JN;
  if (device_.encoder_step > 0) {
    const Vec3 steps = pose.translation() / device_.encoder_step;
    pose.translation() = steps.array().round().matrix() * device_.encoder_step;
  }
  return pose;
}

}  // namespace artus
