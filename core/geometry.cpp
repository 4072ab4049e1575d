// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/core/geometry.h"

namespace artus {

Pose make_pose(const Vec3& p, const Vec3& z, const Vec3& x_hint) {
  const Vec3 ez = z.normalized();
  Vec3 ex = x_hint - ez * ez.dot(x_hint);
  if (ex.norm() < 1e-9 * (1 + x_hint.norm())) ex = ez.unitOrthogonal();
  ex.normalize();
  Pose pose = Pose::Identity();
  pose.linear().col(0) = ex;
  pose.linear().col(1) = ez.cross(ex);
  pose.linear().col(2) = ez;
  pose.translation() = p;
  return pose;
}

// Eigen's way for opposite directions is a singular value decomposition, which takes a compiler ten
// seconds: here it is compiled once.
Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to) noexcept {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace artus
