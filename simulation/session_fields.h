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

template <Like<SyringeChoice> P, class F>
void fields_of(P& choice, F&& visit) {
  auto& [gauge, filled, barrel, air, unbalanced, liquid, seed] = choice;
  visit("gauge", gauge);
  visit("filled", filled);
  visit("barrel", barrel);
  visit("air", air);
  visit("unbalanced", unbalanced);
  visit("liquid", liquid);
  visit("seed", seed);
}

template <Like<HandAids> P, class F>
void fields_of(P& aids, F&& visit) {
  auto& [entry, target, guide, wall, keep_out] = aids;
  visit("entry", entry);
  visit("target", target);
  visit("guide", guide);
  visit("wall", wall);
  visit("keep_out", keep_out);
}

/// All but the feel, whose choices may be unset, the joint's place, and what a recording of before
/// does not have (recording_head.cpp).
template <Like<SessionParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [haptic_rate, image_rate, device, needle, passivity, guard, feel, gesture, X_WJ, transducer,
         image, needle_shape, syringe, aids, deform, wait_for_cage] = params;
  visit("haptic_rate", haptic_rate);
  visit("image_rate", image_rate);
  visit("device", device);
  visit("needle", needle);
  visit("passivity", passivity);
  visit("guard", guard);
  visit("gesture", gesture);
  visit("transducer", transducer);
  visit("image", image);
  visit("needle_shape", needle_shape);
  visit("syringe", syringe);
  visit("aids", aids);
  visit("deform", deform);
}

}  // namespace artus
