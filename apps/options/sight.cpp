// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/sight.h"

#include <algorithm>
#include <limits>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

/// The middle of the skin's triangle nearest to `p`, looking into the body.
std::optional<Pose> nearest_stand(const CompiledJoint& joint, const Vec3& p) {
  std::optional<Pose> stand;
  double least = std::numeric_limits<double>::infinity();
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != kOutside && f.back != kOutside) continue;
    const Vec3& a = joint.mesh.vertices[f.vertices[0]];
    const Vec3& b = joint.mesh.vertices[f.vertices[1]];
    const Vec3& c = joint.mesh.vertices[f.vertices[2]];
    const Vec3 centre = (a + b + c) / 3;
    if ((centre - p).norm() >= least) continue;
    least = (centre - p).norm();
    const Vec3 to_front = (b - a).cross(c - a);
    stand = make_pose(centre, f.front == kOutside ? Vec3(-to_front) : to_front, Vec3::UnitX());
  }
  return stand;
}

}  // namespace

Result<void> check_sight(const Frame& frame, const LoadedView& view) {
  if (std::any_of(frame.contact.begin(), frame.contact.end(), [](float c) { return c > 0; }))
    return {};
  const Vec3 probe = view.X_JP.translation();
  const auto stand = nearest_stand(view.joint(), probe);
  if (!stand) return fail(ErrorCode::invalid, "the joint has no skin to stand on", "--probe");
  const Vec3 p = stand->translation() / kMillimetre;
  const Vec3 z = stand->linear().col(2);
  const std::string text = printed(
      "no part of the probe touches skin, so there is no image; the nearest skin is %.1f mm away, "
      "where --probe=%.1f,%.1f,%.1f/%.3f,%.3f,%.3f stands",
      (p - probe / kMillimetre).norm(), p.x(), p.y(), p.z(), z.x(), z.y(), z.z());
  return fail(ErrorCode::invalid, text, "--probe");
}

}  // namespace artus
