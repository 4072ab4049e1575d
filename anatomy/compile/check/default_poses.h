// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/anatomy/compiled_joint.h"
#include "artus/anatomy/joint_file.h"

namespace artus {

struct DefaultPoses {
  Pose X_JP = Pose::Identity();  ///< probe, footprint centre on the skin
  Pose X_JN = Pose::Identity();  ///< needle, tip at its target
};

/// The poses that the joint file gives. Where it gives no probe, that stands with its whole face on
/// the skin nearest to the needle's tip from where it sees the tip past all bone, with the beam at
/// 40 degrees or more to the needle and the needle in its plane; the needle is the given one or the
/// first planned injection's at its target. With neither, the probe stands on the skin nearest to
/// the middle of the region of interest (of the body, without one) and looks there. A needle still
/// missing comes through the skin in the probe's plane, 45 degrees down to 20 mm under the
/// footprint, or half as deep as what is looked at lies, or less where only that comes through skin
/// and past bone. What was chosen is told in `notes`. Requires: mesh, regions and tissues of
/// `joint` filled in.
[[nodiscard]] DefaultPoses find_default_poses(const JointFile& file, const CompiledJoint& joint,
                                              std::vector<std::string>& notes);

}  // namespace artus
