// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/soft/solver/deformed_body.h"

namespace artus {

/// What share of the liquid in it a body has once tissue has moved, of that at rest: a field of
/// displacements keeps tissue's volume nearly, and a space's not at all. `shape`: the joint `rest`
/// with what was injected. 1: nothing is in it. Cost: a look-up for each corner
/// of the spaces' walls.
[[nodiscard]] double kept_volume(const CompiledJoint& shape, const CompiledJoint& rest,
                                 const DeformedBody& tissue);

}  // namespace artus
