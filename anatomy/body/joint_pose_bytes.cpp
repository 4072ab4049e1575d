// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/joint_pose_bytes.h"

#include <cstdint>

#include "artus/detail/core/rigid.h"

namespace artus {

void put_pose(ByteWriter& out, const Pose& pose) {
  for (Eigen::Index column = 0; column < 4; ++column) {
    for (Eigen::Index row = 0; row < 3; ++row) out.put(pose.matrix()(row, column));
  }
}

Pose get_pose(ByteReader& in) {
  Pose pose = Pose::Identity();
  for (Eigen::Index column = 0; column < 4; ++column) {
    for (Eigen::Index row = 0; row < 3; ++row) pose.matrix()(row, column) = in.get<double>();
  }
  return pose;
}

void put_poses(ByteWriter& out, const std::vector<JointPose>& poses) {
  out.put(static_cast<std::uint32_t>(poses.size()));
  for (const JointPose& p : poses) {
    out.put(std::string_view(p.name));
    out.put(std::string_view(p.title));
    out.put(static_cast<std::uint32_t>(p.motions.size()));
    for (const BoneMotion& m : p.motions) {
      out.put(std::string_view(m.structure));
      put_pose(out, m.X_J);
    }
    out.put(static_cast<std::uint8_t>(p.X_JP ? 1 : 0));
    if (p.X_JP) put_pose(out, *p.X_JP);
  }
}

std::vector<JointPose> get_poses(ByteReader& in) {
  const auto rigid = [&in] {
    const Pose pose = get_pose(in);
    if (!is_rigid(pose)) in.refuse();
    return pose;
  };
  std::vector<JointPose> poses(in.get_count(4));
  for (JointPose& p : poses) {
    p.name = in.get_text();
    p.title = in.get_text();
    p.motions.resize(in.get_count(4));
    for (BoneMotion& m : p.motions) {
      m.structure = in.get_text();
      m.X_J = rigid();
    }
    if (in.get<std::uint8_t>() != 0) p.X_JP = rigid();
  }
  return poses;
}

}  // namespace artus
