// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/overflow.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "artus/detail/anatomy/body/find_region.h"

namespace artus {
namespace {

constexpr double kInto = 0.5e-3;  // m behind the wall, where it begins to part tissue

/// What parts, next to a space.
struct Beyond {
  RegionId region = kOutside;
  Vec3 p = Vec3::Zero();
};

/// Of the space's walls with soft tissue behind them the one that is nearest to the skin's side of
/// the tip: as far as it is away, and twice as far where it is not above.
std::optional<Beyond> tissue_beyond(const CompiledJoint& joint, const OpenedSpace& space,
                                    const Vec3& tip) {
  const auto in_space = [&](RegionId r) {
    return std::find(space.regions().begin(), space.regions().end(), r) != space.regions().end();
  };
  const Vec3 up = -joint.X_JP_default.linear().col(2);
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<Beyond> found;
  for (const Interface& f : joint.mesh.interfaces) {
    if (in_space(f.front) == in_space(f.back)) continue;
    const RegionId beyond = in_space(f.front) ? f.back : f.front;
    if (beyond < kFirstRegion || joint.tissue_of(beyond).haptic.hard) continue;
    const auto& p = joint.mesh.vertices;
    const Vec3& a = p[f.vertices[0]];
    const Vec3 middle = (a + p[f.vertices[1]] + p[f.vertices[2]]) / 3;
    const Vec3 normal = (p[f.vertices[1]] - a).cross(p[f.vertices[2]] - a);
    if (!(normal.norm() > 0)) continue;
    const Vec3 out = (in_space(f.back) ? 1 : -1) * normal.normalized();
    const double away = (middle - tip).norm() * (1.5 - 0.5 * out.dot(up));
    if (away >= nearest) continue;
    nearest = away;
    found = Beyond{beyond, middle + kInto * out};
  }
  return found;
}

}  // namespace

std::vector<Injected> with_overflow(const OpenedSpaces& spaces, std::vector<Injected> places) {
  const CompiledJoint& joint = spaces.joint();
  std::map<const OpenedSpace*, double> room;
  const std::size_t n = places.size();
  for (std::size_t k = 0; k < n; ++k) {
    const auto region = find_region(joint, places[k].region);
    if (!places[k].cavity || !region) continue;
    const OpenedSpace& space = spaces.of(*region);
    double& left = room.try_emplace(&space, space.max_volume()).first->second;
    const double more = places[k].volume - left;
    left = std::max(0.0, -more);
    if (!(more > 0)) continue;
    const auto beyond = tissue_beyond(joint, space, places[k].tip);
    if (!beyond) continue;
    places[k].volume -= more;
    places.push_back({joint.regions[beyond->region].name, more, false, beyond->p, 0});
  }
  return places;
}

}  // namespace artus
