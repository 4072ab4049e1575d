// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/skin_line.h"

#include <cmath>

namespace artus {

std::optional<double> find_skin_along(const CompiledJoint& joint, const Vec3& p,
                                      const Vec3& direction) {
  std::optional<double> nearest;
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != kOutside) continue;
    const Vec3& a = joint.mesh.vertices[f.vertices[0]];
    const Vec3 ab = joint.mesh.vertices[f.vertices[1]] - a;
    const Vec3 ac = joint.mesh.vertices[f.vertices[2]] - a;
    const Vec3 across = direction.cross(ac);
    const double det = ab.dot(across);
    if (det == 0) continue;
    const Vec3 to_p = p - a;
    const double u = to_p.dot(across) / det;
    const Vec3 q = to_p.cross(ab);
    const double v = direction.dot(q) / det;
    if (u < 0 || v < 0 || u + v > 1) continue;
    const double t = ac.dot(q) / det;
    if (!nearest || std::abs(t) < std::abs(*nearest)) nearest = t;
  }
  return nearest;
}

Vec3 moved_onto_skin(const CompiledJoint& joint, const Vec3& p, const Vec3& direction) {
  return p + find_skin_along(joint, p, direction).value_or(0) * direction;
}

}  // namespace artus
