// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/solids/surfacing.h"

namespace artus {

/// The sizes of a wrist, m. All positions scale with `scale`; the thin layers keep their thickness.
struct WristSize {
  double scale = 1;           ///< 1: radius and ulna 50 mm wide together
  double cartilage = 0.9e-3;  ///< on radius, scaphoid and lunate
  double recess = 1.7e-3;     ///< dorsal recess of the radiocarpal joint
};

/// The solids of a right wrist, straight, the palm forward: `body` (outer skin) first, then the
/// parts in the joint file's order of priority, in which they overlap. Frame J is centred on the
/// radius' end, axes LPS (the thumb's side is -x, the palm -y, the hand -z), m. Requires: all sizes
/// > 0.
[[nodiscard]] std::vector<Solid> make_wrist(const WristSize& size);

}  // namespace artus
