// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"
#include "artus/raycast/scene.h"

namespace artus {

/// A probe on the skin whose image plane holds the needle, as near to the joint's default pose as
/// that allows; the default itself when the needle is (nearly) along the beam.
[[nodiscard]] Pose probe_in_plane(const Scene& scene, const Pose& X_JN);

}  // namespace artus
