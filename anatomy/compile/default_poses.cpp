// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile/default_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "artus/core/units.h"

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

using Kernel = CGAL::Simple_cartesian<double>;
using HardTriangles = std::vector<Kernel::Triangle_3>;
using HardTree = CGAL::AABB_tree<CGAL::AABB_traits<
    Kernel, CGAL::AABB_triangle_primitive<Kernel, HardTriangles::const_iterator>>>;

Kernel::Point_3 to_point(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

bool is_hard(const CompiledJoint& joint, RegionId region) {
  return joint.tissue_of(region).haptic.hard;
}

HardTriangles hard_surfaces(const CompiledJoint& joint) {
  HardTriangles hard;
  const auto corner = [&](const Interface& f, std::size_t k) {
    return to_point(joint.mesh.vertices[f.vertices[k]]);
  };
  for (const Interface& f : joint.mesh.interfaces) {
    if (is_hard(joint, f.front) || is_hard(joint, f.back))
      hard.emplace_back(corner(f, 0), corner(f, 1), corner(f, 2));
  }
  return hard;
}

struct Stand {
  double distance = 0;  // m, to what is looked at
  Vec3 position = Vec3::Zero();
};

/// Where on soft skin a probe could stand: centroids of its triangles, the nearest first; only
/// those from which the beam comes at the needle steeply enough to show it.
std::vector<Stand> find_stands(const CompiledJoint& joint, const Sight& sight) {
  constexpr double kAlongNeedle = 0.77;  // cosine of 40 degrees between beam and needle
  std::vector<Stand> stands;
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != kOutside && f.back != kOutside) continue;
    if (is_hard(joint, f.front) || is_hard(joint, f.back)) continue;
    Vec3 centre = Vec3::Zero();
    for (const auto v : f.vertices) centre += joint.mesh.vertices[v] / 3;
    const Vec3 beam = sight.target - centre;
    const double distance = beam.norm();
    if (!(distance > 0)) continue;
    if (sight.needle && std::abs(sight.needle->dot(beam)) > kAlongNeedle * distance) continue;
    stands.push_back({distance, centre});
  }
  std::sort(stands.begin(), stands.end(),
            [](const Stand& a, const Stand& b) { return a.distance < b.distance; });
  return stands;
}

/// The nearest place on the skin that looks past all bone, or the nearest of all; none when there
/// is none. What is looked at may lie on bone, so the last millimetre is not asked for.
std::optional<Vec3> find_skin(const CompiledJoint& joint, const Sight& sight) {
  const std::vector<Stand> stands = find_stands(joint, sight);
  if (stands.empty()) return std::nullopt;
  const HardTriangles hard = hard_surfaces(joint);
  const HardTree tree(hard.begin(), hard.end());
  for (const Stand& stand : stands) {
    if (stand.distance <= kMillimetre) return stand.position;
    const Vec3 end = sight.target + kMillimetre / stand.distance * (stand.position - sight.target);
    if (!tree.do_intersect(Kernel::Segment_3(to_point(stand.position), to_point(end))))
      return stand.position;
  }
  return stands.front().position;
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

DefaultPoses find_default_poses(const JointFile& file, const CompiledJoint& joint,
                                std::vector<std::string>& notes) {
  constexpr double kDepth = 20 * kMillimetre;
  DefaultPoses poses;
  const Sight sight = find_sight(file, joint.mesh);
  if (file.X_JP_default) {
    poses.X_JP = *file.X_JP_default;
  } else if (const auto skin = find_skin(joint, sight)) {
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
