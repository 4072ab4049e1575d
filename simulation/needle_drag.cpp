// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/needle_drag.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/haptics/needle/laws/lugre_friction.h"
#include "artus/detail/haptics/needle/needle_coupling.h"

namespace artus {
namespace {

constexpr double kSpacing = 1.5e-3;  // m
constexpr double kSpeed = 10e-3;     // m/s

double compliance_in(const Haptic& layer, double tissue) {
  return std::min(tissue, max_tissue_compliance(layer.wall_stiffness));
}

/// The first membrane that still holds or, where none does, the layer at the tip.
void push_tip(const Scene& scene, const std::vector<TissueInterval>& layers, double tip,
              double tissue, NeedleDrag& drag) {
  for (const TissueInterval& i : layers) {
    if (i.region < kFirstRegion) continue;
    const Haptic& layer = scene.joint().tissue_of(i.region).haptic;
    if (layer.hard) continue;
    const double compliance = compliance_in(layer, tissue);
    const double pushed = tip - i.entry;
    if (layer.puncture_force > 0 && pushed < layer.puncture_force * compliance) {
      drag = {{}, pushed, pushed / compliance, i.region};
      return;
    }
    if (&i == &layers.back())  // not by its exit, which is the tip's but for rounding
      drag = {{}, layer.cutting_force * compliance, layer.cutting_force, kOutside};
  }
}

}  // namespace

NeedleDrag find_drag(const Scene& scene, const NeedleView& needle, NeedleDirection path,
                     double tissue_compliance) {
  const LugreParams friction;
  const double level = lugre_level(friction, kSpeed);
  const double length = needle.shape.length;
  const Vec3 axis = needle.X_JN.linear().col(2);
  const Segment shaft{needle.X_JN.translation() - length * axis, needle.X_JN.translation()};
  const auto layers = tissue_intervals(scene, shaft);
  NeedleDrag drag;
  if (path == NeedleDirection::in) push_tip(scene, layers, length, tissue_compliance, drag);
  for (const TissueInterval& i : layers) {
    const double exit = std::min(i.exit, length - drag.push);  // beyond, tissue is before the tip
    if (i.region < kFirstRegion || exit <= i.entry) continue;
    const Haptic& tissue = scene.joint().tissue_of(i.region).haptic;
    if (tissue.hard) continue;
    const double in_layer = exit - i.entry;
    const double held = tissue.cutting_force * tissue.friction * level * in_layer / friction.length;
    const int n = std::max(1, static_cast<int>(std::lround(in_layer / kSpacing)));
    for (int k = 0; k < n; ++k)
      drag.shaft.push_back({shaft.start + (i.entry + in_layer * (k + 0.5) / n) * axis,
                            (path == NeedleDirection::in ? 1 : -1) * held / n * axis});
  }
  return drag;
}

}  // namespace artus
