// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/evidence/soft/soft_gates.h"

/// The gates themselves, one function each; soft_gates.h runs them by name.
namespace artus {

[[nodiscard]] SoftGate gate_patch();        ///< linear field in a graded cage
[[nodiscard]] SoftGate gate_uniaxial();     ///< compression with free sides
[[nodiscard]] SoftGate gate_point_force();  ///< Boussinesq's far displacement
[[nodiscard]] SoftGate gate_cantilever();   ///< bending, with and without near incompressibility
[[nodiscard]] SoftGate gate_punch();        ///< flat round punch on a half-space
[[nodiscard]] SoftGate gate_layers();       ///< layered block under the probe's face, by cube size
[[nodiscard]] SoftGate gate_volume();       ///< volume under a deep press
[[nodiscard]] SoftGate gate_balance();    ///< force against reaction, compliance, energy of a path
[[nodiscard]] SoftGate gate_turned();     ///< face turned against the cage
[[nodiscard]] SoftGate gate_bytes();      ///< the same bytes again
[[nodiscard]] SoftGate gate_wild_hand();  ///< random presses and jumps

}  // namespace artus
