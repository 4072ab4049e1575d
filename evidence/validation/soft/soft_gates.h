// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "artus/detail/evidence/gate.h"

/// Gates of the mechanics of tissue that gives way, on blocks, one function each; gates.h runs them
/// by name. Cost: 0.1 to 60 s each.
namespace artus {

/// What was measured, and whether all that it was measured on had come to rest.
struct Settled {
  double value = 0;
  bool at_rest = false;
};

/// What a gate measures is of a state at rest: `at_rest` is what each SoftSolver::settle of it
/// answered, all together.
[[nodiscard]] inline Claim claim_at_rest(const std::string& what, bool at_rest) {
  return claim_that(ClaimKind::independent, what + " is at rest where it is measured", at_rest);
}

[[nodiscard]] Gate gate_patch();         ///< linear field in a graded cage
[[nodiscard]] Gate gate_uniaxial();      ///< compression with free sides
[[nodiscard]] Gate gate_point_force();   ///< Boussinesq's far displacement
[[nodiscard]] Gate gate_cantilever();    ///< bending, with and without near incompressibility
[[nodiscard]] Gate gate_punch();         ///< flat round punch on a half-space
[[nodiscard]] Gate gate_layers();        ///< layered block under the probe's face, by cube size
[[nodiscard]] Gate gate_volume();        ///< volume under a deep press
[[nodiscard]] Gate gate_balance();       ///< force against reaction, compliance, energy of a path
[[nodiscard]] Gate gate_turned();        ///< face turned against the cage
[[nodiscard]] Gate gate_bytes();         ///< the same bytes again
[[nodiscard]] Gate gate_strain_image();  ///< motion found in two pictures
[[nodiscard]] Gate gate_inclusion();     ///< strain of a stiff ball, from two pictures
[[nodiscard]] Gate gate_speckle_pressed();  ///< speckle statistics under compression
[[nodiscard]] Gate gate_vessel();           ///< sphere and tube under pressure
[[nodiscard]] Gate gate_convergence();      ///< stored energy by cube size
[[nodiscard]] Gate gate_reciprocity();      ///< compliance against its transpose
[[nodiscard]] Gate gate_thinning();         ///< layers in the picture against the tissue's
[[nodiscard]] Gate gate_limb();             ///< fat and muscle over bone against published ones
[[nodiscard]] Gate gate_carried();          ///< speckle where the tissue went
[[nodiscard]] Gate gate_border();           ///< echo of a moved border and its speckle's edge
[[nodiscard]] Gate gate_shaft();            ///< a needle's compliance by cube size
[[nodiscard]] Gate gate_needle_rates();     ///< a coupled needle at several rates of the loop
[[nodiscard]] Gate gate_tent();             ///< skin before and after a needle
[[nodiscard]] Gate gate_drag();             ///< a needle's load, in and out
[[nodiscard]] Gate gate_packets();          ///< the probe's force between updates
[[nodiscard]] Gate gate_probe_hands();      ///< hands with a probe on tissue that answers late
[[nodiscard]] Gate gate_wild_hand();        ///< random presses and jumps
[[nodiscard]] Gate gate_still();            ///< the same bytes below a still probe

// Of a compiled joint.
[[nodiscard]] Gate gate_joint_still(const std::shared_ptr<const CompiledJoint>& joint);
[[nodiscard]] Gate gate_joint_pressed(
    const std::shared_ptr<const CompiledJoint>& joint);  ///< by 3 N

}  // namespace artus
