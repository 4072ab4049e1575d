// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/anatomy/compile/check/joint_check.h"

namespace artus {

/// Structures that are not where they should be: all of them outside of the body (it is of another
/// frame: refused), one wholly outside of it or of the region of interest ("lost": refused), one
/// partly outside, one all in a bone, two that are the same; landmarks in metres or far from the
/// body. Requires: `surfaces` of
/// `file`. Cost: some hundred points of each structure in each tree, all faces
/// of one that sticks out.
[[nodiscard]] std::vector<Finding> find_misplaced(const JointFile& file,
                                                  const PreparedSurfaces& surfaces);

/// What does not fit `side` and `axes`: names that say a direction ("medial_meniscus",
/// "lateral_meniscus") and pairs of bones whose order is known (a fibula lies lateral of its
/// tibia), structures and landmarks alike. One finding for each axis on which they contradict it.
[[nodiscard]] std::vector<Finding> find_mirrored(const JointFile& file,
                                                 const PreparedSurfaces& surfaces);

/// Surfaces whose header names another frame than joint.toml's axes: refused, with both. A file
/// that cannot be read is told elsewhere. Errors: none. Cost: reads the files.
[[nodiscard]] std::vector<Finding> find_foreign_frames(const JointSources& sources);

}  // namespace artus
