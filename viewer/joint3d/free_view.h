// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/anatomy/outside/outside_body.h"
#include "artus/detail/viewer/joint3d/orbit_camera.h"

namespace artus {

/// Share of a camera's picture (0.7 rad high and wide) that the person around the joint fills
/// before the joint. Requires: a body with a hole. Cost: linear in its triangles.
[[nodiscard]] double covered_share(const OutsideBody& body, const OrbitCamera& camera);

/// The camera nearest to the one that is asked for from which the person leaves the joint in sight,
/// a twentieth of the picture covered at most; where there is none, the freest. It is turned by
/// steps of 15 degrees, then raised by 0.3 rad, twice at most.
[[nodiscard]] OrbitCamera find_free_view(const OutsideBody& body, const OrbitCamera& asked);

}  // namespace artus
