// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/solids/surfacing.h"

namespace artus {

/// The sizes of an ankle, m. All positions scale with `scale`; the thin layers keep their
/// thickness.
struct AnkleSize {
  double scale = 1;           ///< 1: a talar dome with a radius of 20.7 mm
  double cartilage = 1.2e-3;  ///< on talus and tibia
  double recess = 4e-3;       ///< anterior recess of the tibiotalar joint, full as with an effusion
  double bursa = 0.9e-3;      ///< retrocalcaneal
};

/// The solids of a right ankle, the toes 20 degrees down: `body` (outer skin) first, then the parts
/// in the joint file's order of priority, in which they overlap. Frame J is centred on the axis of
/// the talar dome, axes LPS (lateral is -x, the toes -y), m. Requires: all sizes > 0.
[[nodiscard]] std::vector<Solid> make_ankle(const AnkleSize& size);

}  // namespace artus
