// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/result.h"
#include "artus/detail/soft/solver/soft_body.h"

namespace artus {

/// A probe that was pressed and held until nothing moved.
struct Press {
  Pose X_JP = Pose::Identity();  ///< where the face then is
  double depth = 0;              ///< m along z from the pose it started at; negative: lifted
  double normal_force = 0;       ///< N on the hand, along -z of P
  ContactForce contact;          ///< frame J
  double short_of = 0;           ///< m that the hand was to go deeper; SoftSolverParams::most_force
  bool settled = false;          ///< false: something still moved after the steps allowed
};

/// Presses by `depth` (m), in steps of 1 mm with a fresh tangent each. Errors: none.
[[nodiscard]] Press press_by(SoftBody& body, const Pose& X_JP, double depth);

/// Presses, or lifts a face that begins too deep, until the hand holds `force` (N) within 0.5 %.
/// Errors: failed (not reached within `max_depth`; the tissue does not come to rest there).
/// Requires: a force > 0.
[[nodiscard]] Result<Press> press_with(SoftBody& body, const Pose& X_JP, double force,
                                       double max_depth = 25e-3);

}  // namespace artus
