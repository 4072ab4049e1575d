// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/anatomy/joint_file.h"

namespace artus {

/// The compiled joint of a body's tetrahedra: what does not shape them (tissues, fibre axes,
/// landmarks, poses, injections, spaces) is `file`'s. `notes` are told what was chosen where the
/// file says nothing. Requires: `mesh` was made of a joint file of the same JointFile::shape.
/// Cost: one pass over the tetrahedra, and the search of a probe pose where the file gives none.
[[nodiscard]] CompiledJoint attach_metadata(const JointFile& file, TetMesh mesh, std::string digest,
                                            std::vector<std::string>& notes);

}  // namespace artus
