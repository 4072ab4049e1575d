// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/simulation/two_phase_gesture.h"

namespace artus {

/// The named members, for visit_fields (core/fields.h).
template <Like<GestureParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [p_W, axis_W, beside_probe, steepness] = params;
  visit("p_W", p_W);
  visit("axis_W", axis_W);
  visit("beside_probe", beside_probe);
  visit("steepness", steepness);
}

}  // namespace artus
