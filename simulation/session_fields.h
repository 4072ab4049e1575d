// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/echo/display/image_fields.h"
#include "artus/detail/haptics/guard_fields.h"
#include "artus/detail/haptics/needle/needle_params_fields.h"
#include "artus/detail/simulation/gesture_fields.h"
#include "artus/simulation/session_params.h"

namespace artus {

// The named members, for visit_fields (core/fields.h).

ARTUS_FIELDS(SyringeChoice, gauge, filled, barrel, air, unbalanced, liquid, seed);

ARTUS_FIELDS(HandAids, entry, target, guide, wall, keep_out);

/// All but the feel, whose choices may be unset, the joint's place, the cage's, and what a
/// recording of before does not have (recording_head.cpp).
template <Like<SessionParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [haptic_rate, image_rate, device, needle, passivity, guard, feel, gesture, X_WJ, transducer,
         image, needle_shape, syringe, aids, deform, wait_for_cage, X_JC] = params;
  ARTUS_VISIT_FIELDS(visit, haptic_rate, image_rate, device, needle, passivity, guard, gesture,
                     transducer, image, needle_shape, syringe, aids, deform);
}

}  // namespace artus
