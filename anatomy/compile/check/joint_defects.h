// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/anatomy/compile/labels/joint_sources.h"
#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/core/progress.h"

namespace artus {

/// Reads all surfaces of a joint and lists what is wrong with each and between them. Errors: none;
/// a file that cannot be read is a defect. Cost: n log n in all triangles.
[[nodiscard]] std::vector<Defect> find_joint_defects(const JointSources& sources,
                                                     const DefectOptions& options = {},
                                                     const Progress& progress = {});

}  // namespace artus
