// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/anatomy/compile/labels/compile_surfaces.h"
#include "artus/detail/anatomy/compile/labels/gap.h"
#include "artus/detail/anatomy/compile/labels/part_cache.h"
#include "artus/detail/anatomy/compile/labels/resolve.h"
#include "artus/detail/core/progress.h"

namespace artus {

/// The region of structure `i` of a joint file; the filler is kFirstRegion.
[[nodiscard]] constexpr RegionId region_of_structure(std::size_t i) noexcept {
  return static_cast<RegionId>(kFirstRegion + 1 + i);
}

/// What the mesher needs to know.
struct LabelledSpace {
  RegionLabels labels;
  ResolveOptions resolve;
  std::vector<std::vector<GapCut>> cuts;  ///< (n_structures) what is cut off each gap
};

/// Samples the distance fields of all structures and makes the constructs from them. Structures
/// without a surface and constructs that name one are left out. Distances that are in `parts` are
/// not measured again. Requires: `surfaces` of `file`.
/// Errors: failed when body and region of interest do not meet; invalid when the mesh sizes ask for
/// more than can be made.
[[nodiscard]] Result<LabelledSpace> make_labelled_space(const JointFile& file,
                                                        const PreparedSurfaces& surfaces,
                                                        const Progress& progress,
                                                        const PartCache& parts = {});

}  // namespace artus
