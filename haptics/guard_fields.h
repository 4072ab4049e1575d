// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/haptics/guard.h"
#include "artus/detail/haptics/passivity.h"

namespace artus {

// The named members of what all hands share, for visit_fields (core/fields.h).

ARTUS_FIELDS(GuardParams, max_speed, max_turn_rate, stale_after, ramp_time, force_slew, torque_slew,
             workspace_centre, workspace_half);

ARTUS_FIELDS(PassivityParams, control, max_damping);

/// All but the name.
template <Like<DeviceLimits> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [name, force, torque, workspace, mass, damping, encoder_step, probe_force, probe_torque,
         needle_centre, needle_half, probe_centre, probe_half] = params;
  ARTUS_VISIT_FIELDS(visit, force, torque, workspace, mass, damping, encoder_step, probe_force,
                     probe_torque, needle_centre, needle_half, probe_centre, probe_half);
}

}  // namespace artus
