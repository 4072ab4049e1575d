// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/joint_pose_toml.h"

#include <algorithm>
#include <set>

#include "artus/detail/core/known_names.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kLargestTurn = 120;   // degrees
constexpr double kLargestShift = 0.2;  // m

/// Bones of the file: structures of a hard tissue.
std::set<std::string, std::less<>> bones_of(const JointFile& joint) {
  std::set<std::string, std::less<>> bones;
  for (const Structure& s : joint.structures) {
    const bool hard = std::any_of(joint.tissues.begin(), joint.tissues.end(), [&](const Tissue& t) {
      return t.name == s.tissue && t.haptic.hard;
    });
    if (hard) bones.insert(s.name);
  }
  return bones;
}

/// The point an axis passes through: three numbers, or the name of a landmark.
Vec3 read_axis_place(TomlTable& move, double unit, const JointFile& joint) {
  const auto* node = move.raw().get("through");
  if (node == nullptr || !node->is_string()) return required_place(move, "through", unit);
  const std::string name = move.required_text("through");
  std::set<std::string, std::less<>> names;
  for (const Landmark& l : joint.landmarks) {
    if (l.name == name) return l.position;
    names.insert(l.name);
  }
  move.problem_at("through", "there is no landmark '" + name + "'" + did_you_mean(name, names));
  return Vec3::Zero();
}

/// `degrees` about an axis through a point, then a shift.
Pose read_motion(TomlTable& move, double unit, const JointFile& joint) {
  Pose X_J = Pose::Identity();
  if (move.has("degrees") || move.has("axis") || move.has("through") || !move.has("shift")) {
    const double degrees = move.required_number("degrees", -kLargestTurn, kLargestTurn);
    const Vec3 axis = move.required_vector("axis");
    const Vec3 centre = read_axis_place(move, unit, joint);
    if (move.has("axis") && !(axis.norm() > 0))
      move.problem_at("axis", "must not be zero");
    else if (axis.norm() > 0)
      X_J = Eigen::Translation3d(centre) * Eigen::AngleAxisd(degrees * kDegree, axis.normalized()) *
            Eigen::Translation3d(-centre);
  }
  const Vec3 shift = move.vector("shift", unit).value_or(Vec3::Zero());
  if (shift.norm() > kLargestShift) move.problem_at("shift", "is longer than 20 cm");
  X_J.pretranslate(shift);
  return X_J;
}

JointPose read_pose(const std::string& name, const toml::table& table, double unit,
                    const JointFile& joint, Problems& problems) {
  const std::string what = "pose '" + name + "'";
  TomlTable toml(table, what, problems);
  JointPose pose;
  pose.name = name;
  if (!is_plain_name(name, '_')) toml.problem("its name may contain only a-z, 0-9 and _");
  pose.title = toml.text("title").value_or(name);
  const auto bones = bones_of(joint);
  std::set<std::string, std::less<>> moved;
  for (const auto* t : toml.tables("move")) {
    TomlTable move(*t, what + " move", problems);
    const Pose X_J = read_motion(move, unit, joint);
    for (const std::string& bone : move.required_texts("structures")) {
      const bool known = std::any_of(joint.structures.begin(), joint.structures.end(),
                                     [&](const Structure& s) { return s.name == bone; });
      if (bones.count(bone) == 0)
        move.problem_at("structures", "'" + bone + "' is no " + (known ? "bone" : "structure") +
                                          did_you_mean(bone, bones));
      else if (!moved.insert(bone).second)
        move.problem_at("structures", "'" + bone + "' moves twice");
      pose.motions.push_back({bone, X_J});
    }
    move.finish();
  }
  if (const auto* t = toml.table("probe")) {
    TomlTable probe(*t, what + " probe", problems);
    pose.X_JP = read_probe_pose(probe, unit);
  }
  toml.finish();
  return pose;
}

}  // namespace

Vec3 required_place(TomlTable& toml, std::string_view key, double unit) {
  const Vec3 place = toml.required_vector(key, unit);
  if (place.cwiseAbs().maxCoeff() > kFarthestPlace)
    toml.problem_at(key, "lies more than 10 m from the origin; see to its unit and frame");
  return place;
}

std::optional<Pose> read_probe_pose(TomlTable& probe, double unit) {
  std::optional<Pose> X_JP;
  const Vec3 position = required_place(probe, "position", unit);
  const Vec3 direction = probe.required_vector("direction");
  const Vec3 lateral = probe.vector("lateral").value_or(Vec3::Zero());
  if (probe.has("direction") && !(direction.norm() > 0))
    probe.problem_at("direction", "must not be zero");
  else if (direction.norm() > 0)
    X_JP = make_pose(position, direction, lateral);
  if (lateral.norm() > 0 && lateral.cross(direction).norm() < 1e-6 * lateral.norm())
    probe.problem_at("lateral", "must not be along 'direction'");
  probe.finish();
  return X_JP;
}

std::vector<JointPose> read_poses(TomlTable& toml, double unit, const JointFile& joint) {
  std::vector<JointPose> poses;
  const auto* all = toml.table("pose");
  if (all == nullptr) return poses;
  TomlTable named(*all, "pose", toml.problems());
  for (const auto& [key, node] : *all) {
    const std::string name(key.str());
    if (const auto* table = named.table(name))
      poses.push_back(read_pose(name, *table, unit, joint, toml.problems()));
  }
  named.finish();
  return poses;
}

}  // namespace artus
