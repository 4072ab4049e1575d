// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/input_device.h"

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

bool is_pose(const PlainPose& plain) noexcept {
  constexpr double kReach = 10;  // m, farther than any device on a table
  for (const double x : plain.position) {
    if (!(std::abs(x) < kReach)) return false;
  }
  double norm = 0;
  for (const double x : plain.rotation) norm += x * x;
  return norm > 0.81 && norm < 1.21;
}

const char* to_string(PeerState state) noexcept {
  switch (state) {
    case PeerState::absent:
      return "absent";
    case PeerState::alive:
      return "alive";
    case PeerState::lost:
      return "lost";
    case PeerState::invalid:
      return "invalid";
  }
  return "";
}

}  // namespace artus
