// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/plain_pose.h"

#include <cmath>

namespace artus {

PlainPose to_plain(const Pose& pose) noexcept {
  const Eigen::Quaterniond q(pose.linear());
  const Vec3 p = pose.translation();
  return {{p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}};
}

Pose to_pose(const PlainPose& plain) noexcept {
  const auto& r = plain.rotation;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(r[0], r[1], r[2], r[3]).normalized().toRotationMatrix();
  pose.translation() = Vec3(plain.position[0], plain.position[1], plain.position[2]);
  return pose;
}

bool is_pose(const PlainPose& plain, double reach) noexcept {
  for (const double x : plain.position) {
    if (!(std::abs(x) < reach)) return false;
  }
  double norm = 0;
  for (const double x : plain.rotation) norm += x * x;
  return norm > 0.81 && norm < 1.21;
}

Eigen::Quaterniond rotation_of(const PlainPose& pose) noexcept {
  const auto& r = pose.rotation;
  return Eigen::Quaterniond(r[0], r[1], r[2], r[3]).normalized();
}

PlainPose blend(const PlainPose& a, const PlainPose& b, double share) noexcept {
  PlainPose pose;
  for (std::size_t i = 0; i < 3; ++i)
    pose.position[i] = a.position[i] + share * (b.position[i] - a.position[i]);
  const Eigen::Quaterniond q = rotation_of(a).slerp(share, rotation_of(b));
  pose.rotation[0] = q.w();
  pose.rotation[1] = q.x();
  pose.rotation[2] = q.y();
  pose.rotation[3] = q.z();
  return pose;
}

}  // namespace artus
