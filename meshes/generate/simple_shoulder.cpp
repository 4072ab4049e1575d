// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/simple_shoulder.h"

#include <algorithm>
#include <array>
#include <string>

#include "artus/detail/core/check.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

struct Layer {
  std::string name;
  double thickness = 0;
};

// A ball with the beginning of a shaft: curved everywhere and not a body of revolution.
Field make_bone(double r) {
  return unite(make_ball(Vec3::Zero(), r),
               make_tube({{Vec3(0, 0, -0.2) * r, 0.75 * r},
                          {Vec3(0.1, 0.04, -0.6) * r, 0.72 * r},
                          {Vec3(0.25, 0.1, -1.1) * r, 0.7 * r}}),
               0.3 * r);
}

}  // namespace

std::vector<Solid> make_simple_shoulder(const SimpleShoulderSize& size) {
  const std::array<Layer, 6> outward{{{"bone", 0},
                                      {"cartilage", size.cartilage},
                                      {"tendon", size.tendon},
                                      {"bursa", size.bursa},
                                      {"muscle", size.muscle},
                                      {"skin", size.skin}}};
  ARTUS_REQUIRE(size.head_radius > 0, "the head radius must be positive");
  const Field bone = make_bone(size.head_radius);
  std::vector<Solid> solids;
  double depth = 0;
  for (const Layer& layer : outward) {
    ARTUS_REQUIRE(layer.thickness > 0 || solids.empty(), "every layer needs a thickness");
    depth += layer.thickness;
    solids.push_back({layer.name, grow(bone, depth), Vec3::Zero(),
                      2.5 * size.head_radius + 1.5 * depth, 1.8e-3 + 0.04 * depth, 0.08e-3});
  }
  std::reverse(solids.begin(), solids.end());
  return solids;
}

}  // namespace artus
