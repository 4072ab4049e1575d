// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/anatomy/compiled_joint.h"

namespace artus {

/// How far from `p` along the unit `direction` the line meets the skin, m, the nearest to `p` on
/// either side; none where it does not. Cost: linear in interfaces.
[[nodiscard]] std::optional<double> find_skin_along(const CompiledJoint& joint, const Vec3& p,
                                                    const Vec3& direction);

/// `p` moved along `direction` onto the skin; `p` itself where the line meets none.
[[nodiscard]] Vec3 moved_onto_skin(const CompiledJoint& joint, const Vec3& p,
                                   const Vec3& direction);

}  // namespace artus
