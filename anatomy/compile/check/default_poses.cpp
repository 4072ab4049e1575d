// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/check/default_poses.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "artus/detail/anatomy/compile/check/plan_check.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

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

/// Looks from the skin at something: in the needle's plane, or first along `lateral`.
Pose look(const Vec3& stand, const Sight& sight, const Vec3& lateral = Vec3::UnitX()) {
  return make_pose(stand, sight.target - stand, sight.needle.value_or(lateral));
}

/// From the nearest place on the skin that looks past all bone and on which the whole face stands
/// with no more than gel below it; else the nearest on which it stands, the nearest that looks past
/// bone, the nearest of all; none when there is none. What is looked at may lie on bone, so the
/// last millimetre is not asked for.
std::optional<Pose> find_skin(const CompiledJoint& joint, const Sight& sight,
                              const PlanGround& ground) {
  constexpr std::size_t kMaxTried = 300;  // faces
  const std::vector<Stand> stands = find_stands(joint, sight);
  if (stands.empty()) return std::nullopt;
  const HardTriangles hard = hard_surfaces(joint);
  const HardTree tree(hard.begin(), hard.end());
  std::optional<Pose> first;
  std::optional<Pose> standing;
  std::size_t n_tried = 0;
  for (const Stand& stand : stands) {
    if (stand.distance > kMillimetre) {
      const Vec3 end =
          sight.target + kMillimetre / stand.distance * (stand.position - sight.target);
      if (tree.do_intersect(Kernel::Segment_3(to_point(stand.position), to_point(end)))) continue;
    }
    for (const Vec3& lateral : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
      const Pose X_JP = look(stand.position, sight, lateral);
      if (!first) first = X_JP;
      if (stands_on_skin(ground, X_JP, kGelReach)) return X_JP;
      if (!standing && stands_on_skin(ground, X_JP)) standing = X_JP;
      if (sight.needle) break;
    }
    if (++n_tried == kMaxTried) break;
  }
  if (standing) return standing;
  return first.value_or(look(stands.front().position, sight));
}

/// Whether a needle with this pose comes through skin and meets no bone before its tip.
bool comes_through_skin(const PlanGround& ground, const Pose& X_JN) {
  const Vec3 tip = X_JN.translation();
  const auto layers = ground.layers({tip - kLongestNeedle * X_JN.linear().col(2), tip});
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
    if (layer->name == "outside") return true;
    if (layer->name == "beyond" || layer->hard) return false;
  }
  return false;
}

/// In the probe's plane at 45 degrees to a point under the footprint, from the left or the right,
/// as deep as `depth` where that comes through skin, else less deep.
Pose needle_under(const Pose& X_JP, double depth, const PlanGround& ground) {
  std::optional<Pose> first;
  for (const double share : {1.0, 0.75, 0.5, 0.25}) {
    for (const double side : {-1.0, 1.0}) {
      const Pose X_JN = make_pose(X_JP * Vec3(0, 0, share * depth),
                                  X_JP.linear() * Vec3(side, 0, 1), Vec3::Zero());
      if (!first) first = X_JN;
      if (comes_through_skin(ground, X_JN)) return X_JN;
    }
  }
  return *first;
}

std::string describe(const char* what, const Vec3& p) {
  return printed(
      "joint.toml has no [%s]: one is set at (%.1f, %.1f, %.1f) mm; "
      "give your own",
      what, p.x() / kMillimetre, p.y() / kMillimetre, p.z() / kMillimetre);
}

}  // namespace

DefaultPoses find_default_poses(const JointFile& file, const CompiledJoint& joint,
                                std::vector<std::string>& notes) {
  constexpr double kDepth = 20 * kMillimetre;
  DefaultPoses poses;
  const Sight sight = find_sight(file, joint.mesh);
  if (file.X_JP_default && file.X_JN_default) return {*file.X_JP_default, *file.X_JN_default};
  const PlanGround ground = make_ground(joint, file.region_of_interest);
  if (file.X_JP_default) {
    poses.X_JP = *file.X_JP_default;
  } else if (const auto skin = find_skin(joint, sight, ground)) {
    poses.X_JP = *skin;
    notes.push_back(describe("probe", skin->translation()));
  }
  if (file.X_JN_default) {
    poses.X_JN = *file.X_JN_default;
  } else if (sight.needle && !file.X_JP_default) {
    poses.X_JN = make_pose(sight.target, *sight.needle, Vec3::Zero());
    notes.push_back(describe("needle", sight.target));
  } else {
    const double depth = std::min(kDepth, (sight.target - poses.X_JP.translation()).norm() / 2);
    poses.X_JN = needle_under(poses.X_JP, depth, ground);
    notes.push_back(describe("needle", poses.X_JN.translation()));
  }
  return poses;
}

}  // namespace artus
