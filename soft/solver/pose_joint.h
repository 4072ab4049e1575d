// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/result.h"

namespace artus {

/// How much each vertex of a joint goes with each of some bones.
struct BoneShares {
  Eigen::MatrixXd of_vertex;  ///< (n_vertices, n_bones), 0..1, rows sum to at most 1
};

/// Shares that are 1 in the bone itself, 0 in every other bone, and harmonic between: soft and
/// slack tissue (bursa, joint fluid, fat) takes the change, muscle less, tendon least. Free where
/// the body ends. Requires: names of hard regions with tetrahedra (else not_found). Cost: some s
/// for a joint of 1e6 tetrahedra. Source: the conductances are assumed, see docs/deformation.md.
[[nodiscard]] Result<BoneShares> compute_bone_shares(const CompiledJoint& joint,
                                                     std::span<const std::string> bones);

/// What posing a joint did to it.
struct PosedJoint {
  CompiledJoint joint;       ///< a body like any other, at rest in this pose
  double min_volume = 1;     ///< of a tissue's volume over what it was at rest, the smallest
  double max_volume = 1;     ///< the largest
  double turned_inside = 0;  ///< share of the soft volume whose tetrahedra are folded
};

/// The joint held in a pose: each bone where its motion takes it, exactly; each other point along
/// the screw motions of the bones by its shares of them. Landmarks, plans, needle and probe go with
/// the tissue they are in or nearest to, the probe to the pose's own place where it has one; fibre
/// axes turn with their structure. Errors: not_found (a motion of what is no bone of the joint),
/// invalid (half a turn and more, not finite, bones that run into each other by more than 0.5 mm
/// and deeper than at rest, tissue folded for more than 2 % of its volume). Cost: some s for a
/// joint of 1e6 tetrahedra.
[[nodiscard]] Result<PosedJoint> pose_joint(const CompiledJoint& joint, const JointPose& pose);

/// The pose of that name. Errors: not_found, with the names there are.
[[nodiscard]] Result<JointPose> find_pose(const CompiledJoint& joint, const std::string& name);

}  // namespace artus
