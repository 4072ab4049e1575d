// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/surfacing.h"

namespace artus {

/// The sizes of a knee, m. All positions scale with `scale`; the thin layers keep their thickness.
struct KneeSize {
  double scale = 1;           ///< 1: a femur 88 mm wide at the condyles
  double cartilage = 2.3e-3;  ///< on femur, tibia and patella
  double recess = 6e-3;       ///< suprapatellar recess, filled as with an effusion
};

/// The solids of a right knee, straight: `body` (outer skin) first, then bones with cartilage and
/// menisci, tendons and ligaments, the suprapatellar recess, muscles, vessels and nerve. They
/// overlap; the joint file's priority decides. Frame J is centred between the condyles, axes LPS
/// (lateral is -x), m. Requires: all sizes > 0.
[[nodiscard]] std::vector<Solid> make_knee(const KneeSize& size);

}  // namespace artus
