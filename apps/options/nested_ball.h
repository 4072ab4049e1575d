// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/result.h"

namespace artus {

/// Six tissues of the library as spheres in one another, shoulder-sized, 120,000 triangles, with an
/// injection to the centre: a body for who measures a machine and names no joint. It does not give
/// way. Errors: those of the tissue library.
[[nodiscard]] Result<std::shared_ptr<const CompiledJoint>> make_nested_ball();

}  // namespace artus
