// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/limb.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

constexpr double kBandPower = 2.4;  // of a section, which thins out to its edges
constexpr double kReach = 0.25;     // m, holds every part

Solid make_part(std::string name, Field field, const Vec3& seed, double half_thickness) {
  const double facet = std::clamp(1.1 * half_thickness, 1.2e-3, 3.5e-3);
  return {std::move(name), std::move(field), seed, kReach, facet, 0.08 * facet};
}

template <class Stations>
double thickest(const Stations& stations) {
  double most = 0;
  for (const auto& s : stations) most = std::max(most, s.back());
  return most;
}

}  // namespace

Field make_rod(const Millimetres& mm, const std::vector<RodStation>& stations) {
  std::vector<TubeStation> tube;
  for (const auto& [x, y, z, radius] : stations)
    tube.push_back({mm.at(x, y, z), mm.length(radius)});
  return make_tube(tube);
}

Field make_strap(const Millimetres& mm, const Vec3& normal,
                 const std::vector<StrapStation>& stations) {
  std::vector<RibbonStation> ribbon;
  for (const auto& [x, y, z, wide, thick] : stations)
    ribbon.push_back({mm.at(x, y, z), normal.normalized(), mm.length(wide), mm.length(thick)});
  return make_ribbon(ribbon, kBandPower);
}

Solid make_rod_part(std::string name, const Millimetres& mm,
                    const std::vector<RodStation>& stations) {
  const RodStation& s = stations.at(1);
  return make_part(std::move(name), make_rod(mm, stations), mm.at(s[0], s[1], s[2]),
                   mm.length(thickest(stations)));
}

Solid make_strap_part(std::string name, const Millimetres& mm, const Vec3& normal,
                      const std::vector<StrapStation>& stations) {
  const StrapStation& s = stations.at(1);
  return make_part(std::move(name), make_strap(mm, normal, stations), mm.at(s[0], s[1], s[2]),
                   mm.length(thickest(stations)));
}

Field make_layer(const Field& inner, double begin, double end, const Field& outline) {
  const double rim = 1.2 * (end - std::max(begin, 0.0));
  return intersect(subtract(grow(inner, end), grow(inner, begin), 0.1 * (end - begin)), outline,
                   rim);
}

Vec3 find_outside(const Field& field, const Vec3& from, const Vec3& direction, double distance) {
  constexpr double kStep = 0.02e-3;  // m
  const Vec3 step = kStep * direction.normalized();
  Vec3 p = from;
  for (int i = 0; i < 10000; ++i, p += step)
    if (field(p) >= distance) return p;
  ARTUS_REQUIRE(false, "the line does not leave the field");
  return p;
}

void append(std::vector<Solid>& solids, std::vector<Solid> parts) {
  solids.insert(solids.end(), std::make_move_iterator(parts.begin()),
                std::make_move_iterator(parts.end()));
}

}  // namespace artus
