// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/solids/surfacing.h"

namespace artus {

/// The sizes of a hip, m. All positions scale with the head; the thin layers keep their thickness.
struct HipSize {
  double head_radius = 24e-3;  ///< bony femoral head
  double cartilage = 1.8e-3;   ///< on the head, and in the socket
  double recess = 4e-3;        ///< anterior recess before the neck, filled as with an effusion
  double capsule = 3.2e-3;     ///< before the recess, with the iliofemoral ligament
};

/// The solids of a right hip: `body` (outer skin) first, then bones with cartilage and labrum,
/// recess and capsule, muscles with tendons, femoral vessels and nerve. They overlap; the joint
/// file's priority decides. Frame J is centred on the femoral head, axes LPS (lateral is -x), m.
/// Requires: all sizes > 0.
[[nodiscard]] std::vector<Solid> make_hip(const HipSize& size);

/// The parts make_hip puts together, for tests: bones with cartilage and labrum; recess and
/// capsule; muscles with tendons; what only some variants of the joint have.
[[nodiscard]] std::vector<Solid> make_hip_bones(const HipSize& size);
[[nodiscard]] std::vector<Solid> make_hip_capsule(const HipSize& size);
[[nodiscard]] std::vector<Solid> make_hip_muscles(const HipSize& size);
[[nodiscard]] std::vector<Solid> make_hip_variants(const HipSize& size);

/// Femur with head, neck and trochanters.
[[nodiscard]] Field make_hip_femur(const HipSize& size);

/// What capsule and iliopsoas lie on: head with its cartilage and neck, without their fine shape.
[[nodiscard]] Field make_front_of_hip(const HipSize& size);

}  // namespace artus
