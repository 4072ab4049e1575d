// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/simulation/two_phase_gesture.h"

namespace artus {

/// The named members, for visit_fields (core/fields.h).
ARTUS_FIELDS(GestureParams, p_W, axis_W, beside_probe, steepness);

}  // namespace artus
