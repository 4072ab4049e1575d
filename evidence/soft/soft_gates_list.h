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
[[nodiscard]] SoftGate gate_balance();  ///< force against reaction, compliance, energy of a path
[[nodiscard]] SoftGate gate_turned();   ///< face turned against the cage
[[nodiscard]] SoftGate gate_bytes();    ///< the same bytes again
[[nodiscard]] SoftGate gate_strain_image();     ///< motion found in two pictures
[[nodiscard]] SoftGate gate_inclusion();        ///< strain of a stiff ball, from two pictures
[[nodiscard]] SoftGate gate_speckle_pressed();  ///< speckle statistics under compression
[[nodiscard]] SoftGate gate_vessel();           ///< sphere and tube under pressure
[[nodiscard]] SoftGate gate_convergence();      ///< stored energy by cube size
[[nodiscard]] SoftGate gate_reciprocity();      ///< compliance against its transpose
[[nodiscard]] SoftGate gate_thinning();         ///< layers in the picture against the tissue's
[[nodiscard]] SoftGate gate_limb();             ///< fat and muscle over bone against published ones
[[nodiscard]] SoftGate gate_tent();             ///< skin before and after a needle
[[nodiscard]] SoftGate gate_drag();             ///< a needle's load, in and out
[[nodiscard]] SoftGate gate_packets();          ///< the probe's force between updates
[[nodiscard]] SoftGate gate_wild_hand();        ///< random presses and jumps

}  // namespace artus
