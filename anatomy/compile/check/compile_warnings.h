// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/compile/labels/compile_labels.h"
#include "artus/detail/anatomy/compile/labels/compile_report.h"
#include "artus/detail/anatomy/compile/labels/compile_surfaces.h"
#include "artus/detail/anatomy/compile/labels/region_labels.h"

namespace artus {

/// Writes into `report` (measured already) what an author should look at: structures of doubtful
/// size or place, of which nothing is left, which stick out of the skin, lose much to others, or
/// whose tetrahedra hold less than their surface. Cost: one look at each surface triangle.
void append_warnings(const JointFile& file, const RegionLabels& labels,
                     const PreparedSurfaces& surfaces, CompileReport& report);

/// Writes into `report` (measured already) what is cut off gaps, by what, where and how much.
void append_gap_cuts(const JointFile& file, const LabelledSpace& space, CompileReport& report);

}  // namespace artus
