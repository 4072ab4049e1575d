// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <random>
#include <vector>

#include "artus/detail/devices/kit/tracker.h"
#include "tests/kit/rendered_view.h"

namespace artus::test {

/// Where things stand before a camera, in the sheet's frame.
struct KitScene {
  Pose X_SC;           ///< the camera
  Pose X_SN;           ///< the needle
  Pose X_SP;           ///< the probe's face
  double plunger = 0;  ///< m, positive in
};

/// A camera that looks at the block from `distance` m, from the bottom of the page, `above` rad
/// over it.
[[nodiscard]] Pose camera_at(double distance, double above, double beside);
/// Probe on the block (`block` m high), needle beside and in its plane by a little; as a right hand
/// has it. `depth`: m of the tip under the probe's face.
[[nodiscard]] KitScene make_scene(std::mt19937_64& random, double distance, double depth);
/// Needle and probe by their places on the block: `offset` m across the plane.
[[nodiscard]] Pose needle_towards(const Vec3& tip_P, double steepness, double offset,
                                  const Pose& X_SP);

/// What the camera sees of it, with `kit` as it really is.
[[nodiscard]] std::vector<ShownBody> bodies_of(const KitScene& scene, const kit::Kit& kit);

}  // namespace artus::test
