// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/anatomy/compile/check/joint_check.h"

namespace artus {

/// Structures that are not where they should be: all of them outside of the body (it is of another
/// frame: refused), one of which nothing, or much less than was given, would be in the joint
/// ("lost": refused): more than half of its surface in the region outside of the body, three
/// quarters of it taken by what stands before it, wholly outside of the region of interest unless a
/// variant has set that, or the same as another one; one partly outside, one all in a bone;
/// landmarks in metres or far from the body. Requires: `surfaces` of `file`. Cost: some hundred
/// points of each structure in each tree, all faces of one that sticks out.
[[nodiscard]] std::vector<Finding> find_misplaced(const JointFile& file,
                                                  const PreparedSurfaces& surfaces);

/// What does not fit `side` and `axes`: names that say a direction ("medial_meniscus",
/// "lateral_meniscus") and pairs of bones whose order is known (a fibula lies lateral of its
/// tibia), structures and landmarks alike. One finding for each axis on which they contradict it.
[[nodiscard]] std::vector<Finding> find_mirrored(const JointFile& file,
                                                 const PreparedSurfaces& surfaces);

/// Structures that lie outside of the skin or in bone, and would not if they were mirrored along an
/// axis, turned from RAS to LPS, or 10, 25.4, 100 or 1000 times as large or small: named with that
/// number and the distance, and refused where nine tenths of it lie there. A mirrored structure
/// that lies in soft tissue cannot be told from one that is meant. Requires: `surfaces` of `file`.
/// Cost: two hundred points of each structure in the trees of body and bones, twelve times for one
/// that does not fit.
[[nodiscard]] std::vector<Finding> find_other_frames(const JointFile& file,
                                                     const PreparedSurfaces& surfaces);

/// Poses ([pose.NAME]) that press a bone more than 1 mm deeper into another than it lies at rest:
/// refused, with depth and place. Requires: `surfaces` of `file`. Cost: four thousand points of
/// each bone that moves against another, in its tree.
[[nodiscard]] std::vector<Finding> find_pressed_bones(const JointFile& file,
                                                      const PreparedSurfaces& surfaces);

/// Surfaces whose header names another frame than joint.toml's axes: refused, with both. A file
/// that cannot be read is told elsewhere. Errors: none. Cost: reads the files.
[[nodiscard]] std::vector<Finding> find_foreign_frames(const JointSources& sources);

}  // namespace artus
