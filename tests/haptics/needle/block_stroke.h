// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "artus/haptics/needle_renderer.h"
#include "tests/support/layered_body.h"

namespace artus::test {

/// Six flat layers from skin to bone, 49 mm, at X.
inline std::shared_ptr<const Scene> block(const Pose& X = Pose::Identity()) {
  const std::vector<FlatLayer> layers{{"skin", 0.003},   {"muscle", 0.015},    {"bursa", 0.003},
                                      {"tendon", 0.005}, {"cartilage", 0.003}, {"bone", 0.02}};
  return std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(transformed(make_layered_block(layers, 0.2, 0.2), X)));
}

/// A needle for 0.3 s outside, in to 33 mm (bone at 29 mm) and out, with a little sideways motion.
inline TimedPose stroke(double t) {
  const double z = -0.005 + 0.038 * 0.5 * (1 - std::cos(3.0 * std::max(0.0, t - 0.3)));
  return {
      make_pose(Vec3(1e-3 * std::sin(5 * t), 0, z), Vec3(0.05 * std::sin(t), 0, 1), Vec3::UnitX()),
      t};
}

}  // namespace artus::test
