// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/evidence/runs/three_injections.h"

namespace artus {

/// Fills plateaus, touches and claims from the rows. `reached`: every phase met its goal in time.
void analyze(const CompiledJoint& joint, bool reached, ThreeInjections& run);

}  // namespace artus
