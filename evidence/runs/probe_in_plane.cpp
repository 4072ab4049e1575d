// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/probe_in_plane.h"

namespace artus {
namespace {

constexpr double kNeedleAlongBeam = 0.2;  // sine of the angle below which no plane is defined

// The probe moved along its beam onto the skin and turned within its image plane until it lies
// flat.
Pose seat_on_skin(const Scene& scene, const Pose& X_JP) {
  constexpr double kReach = 0.05;  // m that the skin may be away from the footprint
  const Vec3 z = X_JP.linear().col(2);
  const Vec3 p = X_JP.translation();
  for (const TissueInterval& s : tissue_intervals(scene, {p - kReach * z, p + kReach * z})) {
    if (s.region == kOutside || s.entry_normal.isZero()) continue;
    const Vec3 y = X_JP.linear().col(1);
    const Vec3 inward = -(s.entry_normal - y * y.dot(s.entry_normal));
    const Vec3 on_skin = p + (s.entry - kReach) * z;
    if (inward.norm() < 0.1) return make_pose(on_skin, z, X_JP.linear().col(0));
    return make_pose(on_skin, inward, y.cross(inward));
  }
  return X_JP;
}

}  // namespace

Pose probe_in_plane(const Scene& scene, const Pose& X_JN) {
  constexpr double kAimDepth = 0.02;  // m below the footprint: where the image is looked at most
  const Pose& rest = scene.joint().X_JP_default;
  const Vec3 z = rest.linear().col(2);
  const Vec3 needle = X_JN.linear().col(2);
  const Vec3 across = needle - needle.dot(z) * z;
  if (across.norm() < kNeedleAlongBeam) return rest;
  const Vec3 x = across.normalized() * (across.dot(rest.linear().col(0)) < 0 ? -1.0 : 1.0);
  const Vec3 y = z.cross(x);
  // The line's point nearest to the middle of the default image comes into the middle: the same for
  // every depth of the tip, so the probe stays while the needle moves.
  const Vec3 middle = rest.translation() + kAimDepth * z;
  const Vec3 aim = X_JN.translation() + needle * needle.dot(middle - X_JN.translation());
  const Vec3 offset = aim - rest.translation();
  const Pose slid = make_pose(rest.translation() + y * y.dot(offset) + x * x.dot(offset), z, x);
  return seat_on_skin(scene, slid);
}

}  // namespace artus
