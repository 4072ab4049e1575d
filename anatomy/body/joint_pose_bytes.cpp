// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/joint_pose_bytes.h"

#include <cstdint>

#include "artus/detail/core/rigid.h"

namespace artus {
namespace {

Pose get_rigid(ByteReader& in) {
  const Pose pose = get_pose(in);
  if (!is_rigid(pose)) in.refuse();
  return pose;
}

}  // namespace

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
  std::vector<JointPose> poses(in.get_count(4));
  for (JointPose& p : poses) {
    p.name = in.get_text();
    p.title = in.get_text();
    p.motions.resize(in.get_count(4));
    for (BoneMotion& m : p.motions) {
      m.structure = in.get_text();
      m.X_J = get_rigid(in);
    }
    if (in.get<std::uint8_t>() != 0) p.X_JP = get_rigid(in);
  }
  return poses;
}

void put_views(ByteWriter& out, const std::vector<StandardView>& views) {
  out.put(static_cast<std::uint32_t>(views.size()));
  for (const StandardView& v : views) {
    for (const std::string* text : {&v.name, &v.title, &v.source, &v.shows, &v.pose})
      out.put(std::string_view(*text));
    put_pose(out, v.X_JP);
    out.put(v.depth);
    out.put(static_cast<std::uint32_t>(v.sights.size()));
    for (const ViewSight& s : v.sights) {
      out.put(std::string_view(s.structure));
      out.put(s.least);
      out.put(s.most);
      out.put(static_cast<std::uint8_t>(s.side));
    }
  }
}

std::vector<StandardView> get_views(ByteReader& in) {
  std::vector<StandardView> views(in.get_count(4));
  for (StandardView& v : views) {
    for (std::string* text : {&v.name, &v.title, &v.source, &v.shows, &v.pose})
      *text = in.get_text();
    v.X_JP = get_rigid(in);
    v.depth = in.get<double>();
    v.sights.resize(in.get_count(4));
    for (ViewSight& s : v.sights) {
      s.structure = in.get_text();
      s.least = in.get<double>();
      s.most = in.get<double>();
      const auto side = in.get<std::uint8_t>();
      if (side > 2) in.refuse();
      s.side = static_cast<ViewSide>(side);
    }
  }
  return views;
}

}  // namespace artus
