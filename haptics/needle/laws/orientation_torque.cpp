// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/orientation_torque.h"

#include <cmath>

#include "artus/detail/haptics/needle/laws/clamping.h"

namespace artus {

Vec3 orientation_error(const Eigen::Quaterniond& current,
                       const Eigen::Quaterniond& reference) noexcept {
  const Eigen::Quaterniond q = current.conjugate() * reference;
  const double norm = q.vec().norm();
  if (norm == 0) return Vec3::Zero();
  const double angle = 2 * std::atan2(norm, std::abs(q.w()));
  const Vec3 in_needle = (q.w() < 0 ? -angle : angle) / norm * q.vec();
  return current * in_needle;
}

void OrientationTorque::reset(double /*depth*/) noexcept {}

Wrench OrientationTorque::step(const NeedleTick& tick) noexcept {
  if (tick.depth <= 0) return {};
  const double scale = clamping_stiffness(tick) / params_.reference_clamping;
  const Vec3 error = orientation_error(tick.orientation, tick.orientation_0);
  const Vec3 torque = scale * params_.stiffness * error - params_.damping * tick.angular_velocity;
  return {Vec3::Zero(), torque - tick.axis * tick.axis.dot(torque)};
}

}  // namespace artus
