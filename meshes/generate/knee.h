// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/solids/surfacing.h"

namespace artus {

/// The sizes of a knee, m. All positions scale with `scale`; the thin layers keep their thickness.
struct KneeSize {
  double scale = 1;           ///< 1: a femur 81 mm wide at the condyles
  double cartilage = 2.3e-3;  ///< on the condyles and the tibia; thicker in trochlea and patella
  double recess = 6e-3;       ///< suprapatellar recess, filled as with an effusion
  double patellar_tendon = 4.7e-3;    ///< thickness of the patellar tendon
  double quadriceps_tendon = 6.6e-3;  ///< thickness of the quadriceps tendon above the patella
};

/// The solids of a right knee, straight: `body` (outer skin) first, then bones with cartilage and
/// menisci, soft tissue, vessels and nerve. They overlap; the joint file's priority decides. Frame
/// J is centred between the condyles, axes LPS (lateral is -x), m. Requires: all sizes > 0.
[[nodiscard]] std::vector<Solid> make_knee(const KneeSize& size);

/// The parts make_knee puts together, for tests: bones with cartilage and menisci; tendons,
/// ligaments, recess, fat pads and muscles; what only some variants of the joint have.
[[nodiscard]] std::vector<Solid> make_knee_bones(const KneeSize& size);
[[nodiscard]] std::vector<Solid> make_knee_soft_tissue(const KneeSize& size);
[[nodiscard]] std::vector<Solid> make_knee_muscles(const KneeSize& size);
[[nodiscard]] std::vector<Solid> make_knee_variants(const KneeSize& size);

/// Femur with trochlea, condyles and epicondyles.
[[nodiscard]] Field make_knee_femur(const KneeSize& size);

}  // namespace artus
