// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>

#include "artus/core/geometry.h"

namespace artus {

/// The point of a triangle (with its edges and corners) nearest to `p`; exact up to rounding, also
/// for triangles without area. Source [Ericson2004] section 5.1.5.
[[nodiscard]] Vec3 closest_point_on_triangle(const Vec3& p,
                                             const std::array<Vec3, 3>& corners) noexcept;

}  // namespace artus
