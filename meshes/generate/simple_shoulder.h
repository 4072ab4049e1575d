// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/solids/surfacing.h"

namespace artus {

/// The six-layer joint: thickness of each layer around the bone, m. Thicker than anatomy where a
/// needle's cutting force would not reach its plateau inside an anatomical layer.
struct SimpleShoulderSize {
  double head_radius = 24e-3;  ///< of the bone's ball
  double cartilage = 3e-3;
  double tendon = 6e-3;
  double bursa = 2.5e-3;
  double muscle = 14e-3;
  double skin = 3.5e-3;
};

/// Six nested solids, outermost first: skin, muscle, bursa, tendon, cartilage, bone. Each is the
/// bone grown by the layers inside, so every layer has the same thickness everywhere. Frame J is
/// centred on the ball, axes LPS, m. Requires: all sizes > 0.
[[nodiscard]] std::vector<Solid> make_simple_shoulder(const SimpleShoulderSize& size);

}  // namespace artus
