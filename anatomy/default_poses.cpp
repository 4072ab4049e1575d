// SPDX-License-Identifier: AGPL-3.0-or-later
#include "anatomy/default_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "core/units.h"

namespace artus {
namespace {

Vec3 middle_of(const JointFile& file, const TetMesh& mesh) {
  if (file.region_of_interest) return file.region_of_interest->centre;
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : mesh.vertices) sum += p;
  return sum / static_cast<double>(std::max<std::size_t>(mesh.vertices.size(), 1));
}

/// What the probe should look at, and the needle it should see there, if one is planned.
struct Sight {
  Vec3 target = Vec3::Zero();
  std::optional<Vec3> needle;  // unit, along its axis
};

Sight find_sight(const JointFile& file, const TetMesh& mesh) {
  if (file.X_JN_default) {
    return {file.X_JN_default->translation(), file.X_JN_default->linear().col(2)};
  }
  if (!file.injections.empty()) {
    const PlannedInjection& first = file.injections.front();
    return {first.target, (first.target - first.entry).normalized()};
  }
  return {middle_of(file, mesh), std::nullopt};
}

/// The centroid of the skin triangle nearest to what is looked at, of those from which the beam
/// comes at the needle steeply enough to show it; none when there is none.
std::optional<Vec3> find_skin(const TetMesh& mesh, const Sight& sight) {
  constexpr double kAlongNeedle = 0.77;  // cosine of 40 degrees between beam and needle
  std::optional<Vec3> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const Interface& f : mesh.interfaces) {
    if (f.front != kOutside && f.back != kOutside) continue;
    Vec3 centre = Vec3::Zero();
    for (const auto v : f.vertices) centre += mesh.vertices[v] / 3;
    const Vec3 beam = sight.target - centre;
    const double distance = beam.norm();
    if (!(distance > 0) || distance >= least) continue;
    if (sight.needle && std::abs(sight.needle->dot(beam)) > kAlongNeedle * distance) continue;
    least = distance;
    nearest = centre;
  }
  return nearest;
}

std::string describe(const char* what, const Vec3& p) {
  std::array<char, 200> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(),
                                  "joint.toml has no [%s]: one is set at (%.1f, %.1f, %.1f) mm; "
                                  "give your own",
                                  what, p.x() / kMillimetre, p.y() / kMillimetre,
                                  p.z() / kMillimetre));
  return text.data();
}

}  // namespace

DefaultPoses find_default_poses(const JointFile& file, const TetMesh& mesh,
                                std::vector<std::string>& notes) {
  constexpr double kDepth = 20 * kMillimetre;
  DefaultPoses poses;
  const Sight sight = find_sight(file, mesh);
  if (file.X_JP_default) {
    poses.X_JP = *file.X_JP_default;
  } else if (const auto skin = find_skin(mesh, sight)) {
    poses.X_JP = make_pose(*skin, sight.target - *skin, sight.needle.value_or(Vec3::UnitX()));
    notes.push_back(describe("probe", *skin));
  }
  if (file.X_JN_default) {
    poses.X_JN = *file.X_JN_default;
  } else if (sight.needle && !file.X_JP_default) {
    poses.X_JN = make_pose(sight.target, *sight.needle, Vec3::Zero());
    notes.push_back(describe("needle", sight.target));
  } else {
    const double depth = std::min(kDepth, (sight.target - poses.X_JP.translation()).norm() / 2);
    const Vec3 target = poses.X_JP * Vec3(0, 0, depth);
    poses.X_JN = make_pose(target, poses.X_JP.linear() * Vec3(-1, 0, 1), Vec3::Zero());
    notes.push_back(describe("needle", target));
  }
  return poses;
}

}  // namespace artus
