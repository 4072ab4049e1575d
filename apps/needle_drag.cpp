// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/apps/needle_drag.h"

#include <algorithm>
#include <cmath>

#include "artus/haptics/needle/lugre_friction.h"

namespace artus {
namespace {

constexpr double kSpacing = 1.5e-3;  // m
constexpr double kSpeed = 10e-3;     // m/s

}  // namespace

std::vector<PointLoad> sliding_loads(const Scene& scene, const NeedleView& needle, NeedleWay way) {
  const LugreParams friction;
  const double level = lugre_level(friction, kSpeed);
  const Vec3 axis = needle.X_JN.linear().col(2);
  const Vec3 tip = needle.X_JN.translation();
  const Segment shaft{tip - needle.shape.length * axis, tip};
  std::vector<PointLoad> loads;
  const Haptic* at_tip = nullptr;
  for (const TissueInterval& i : tissue_intervals(scene, shaft)) {
    at_tip = nullptr;
    if (i.region < kFirstRegion) continue;
    const Haptic& tissue = scene.joint().tissue_of(i.region).haptic;
    if (tissue.hard) continue;
    at_tip = &tissue;
    const double length = i.exit - i.entry;
    const double held = tissue.cutting_force * tissue.friction * level * length / friction.length;
    const int n = std::max(1, static_cast<int>(std::lround(length / kSpacing)));
    for (int k = 0; k < n; ++k)
      loads.push_back({shaft.start + (i.entry + length * (k + 0.5) / n) * axis,
                       (way == NeedleWay::in ? 1 : -1) * held / n * axis});
  }
  if (at_tip != nullptr && way == NeedleWay::in)
    loads.push_back({tip, at_tip->cutting_force * axis});
  return loads;
}

}  // namespace artus
