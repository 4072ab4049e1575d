// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/goals.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/anatomy/body/find_region.h"
#include "artus/detail/anatomy/body/space.h"

namespace artus {
namespace {

constexpr double kFar = 0.5;            // m within which structures are looked for
constexpr double kLookEvery = 0.25e-3;  // m

/// m beyond the zone's edge; negative outside.
double depth_in(const AvoidZone& zone, const Vec3& p) {
  return zone.margin - zone.body->signed_distance_to_skin(p, kFar);
}

}  // namespace

double distance_to(const Target& target, const Vec3& p_J) noexcept {
  if (target.point) return (p_J - *target.point).norm();
  if (target.body == nullptr) return 0;
  return std::max(0.0, target.body->signed_distance_to_skin(p_J, kFar));
}

std::vector<bool> place_of(const std::string& structure, const CompiledJoint& joint) {
  std::vector<bool> in(joint.regions.size(), false);
  const auto region = find_region(joint, structure);
  const auto spaces = make_joint_spaces(joint);
  if (!region || !spaces) return in;
  for (std::size_t r = 0; r < in.size(); ++r)
    in[r] = spaces->of_region[r] == spaces->of_region[*region];
  return in;
}

Intrusion find_intrusion(const AvoidZone& zone, std::span<const CoursePoint> course) {
  Intrusion out;
  bool inside = false;
  for (std::size_t i = 1; i < course.size(); ++i) {
    const CoursePoint& from = course[i - 1];
    const CoursePoint& to = course[i];
    if (!to.inside() && !from.inside()) {
      inside = false;
      continue;
    }
    const auto n = std::max<long>(1, std::lround(std::ceil(to.step / kLookEvery)));
    const double dt = (to.time - from.time) / static_cast<double>(n);
    for (long k = 1; k <= n; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(n);
      const double depth = depth_in(zone, from.tip + share * (to.tip - from.tip));
      const bool now = depth > 0;
      if (now && !inside) {
        ++out.entries;
        if (!out.first) out.first = from.time + dt * static_cast<double>(k);
      }
      if (now) out.time += dt;
      out.depth = std::max(out.depth, depth);
      inside = now;
    }
  }
  return out;
}

}  // namespace artus
