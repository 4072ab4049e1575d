// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// Volume of all places that a closed surface encloses, m^3. signed_volume counts a place once for
/// each piece or fold around it, so a surface that is there twice has twice the volume; here it
/// counts once. What is counted too often is measured along 200 x 200 lines, exact along each.
/// Requires: closed, oriented outward. Cost: linear in the triangles and the lines they meet.
[[nodiscard]] double enclosed_volume(const SurfaceMesh& mesh);

}  // namespace artus
