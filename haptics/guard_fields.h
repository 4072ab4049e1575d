// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/haptics/guard.h"
#include "artus/detail/haptics/passivity.h"

namespace artus {

// The named members of what all hands share, for visit_fields (core/fields.h).

template <Like<GuardParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [speed, turn, stale, ramp, force_slew, torque_slew, centre, half] = params;
  visit("max_speed", speed);
  visit("max_turn_rate", turn);
  visit("stale_after", stale);
  visit("ramp_time", ramp);
  visit("force_slew", force_slew);
  visit("torque_slew", torque_slew);
  visit("workspace_centre", centre);
  visit("workspace_half", half);
}

template <Like<PassivityParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [control, max_damping] = params;
  visit("control", control);
  visit("max_damping", max_damping);
}

/// All but the name.
template <Like<DeviceLimits> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [name, force, torque, workspace, mass, damping, encoder_step] = params;
  visit("force", force);
  visit("torque", torque);
  visit("workspace", workspace);
  visit("mass", mass);
  visit("damping", damping);
  visit("encoder_step", encoder_step);
}

}  // namespace artus
