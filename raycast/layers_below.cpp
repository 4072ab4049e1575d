// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/raycast/layers_below.h"

#include "artus/raycast/scene.h"

namespace artus {
namespace {

constexpr double kAbove = 20e-3;  // m from the face to where the path begins
constexpr double kBelow = 60e-3;  // m from the face to where it ends

}  // namespace

std::vector<LayerBelow> layers_below(const DeformedBody& body, const Pose& X_JP) {
  const Vec3 z = X_JP.linear().col(2);
  const Segment segment{X_JP.translation() - kAbove * z, X_JP.translation() + kBelow * z};
  const auto now = [&](double depth) {
    return depth + body.displacement(segment.start + depth * z).dot(z);
  };
  std::vector<LayerBelow> layers;
  for (const TissueInterval& i : tissue_intervals(Scene(body.shared_joint()), segment)) {
    if (i.region < kFirstRegion) continue;
    if (body.joint().tissue_of(i.region).haptic.hard) break;
    layers.push_back({i.region, i.exit - i.entry, now(i.exit) - now(i.entry)});
  }
  return layers;
}

}  // namespace artus
