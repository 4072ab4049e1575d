// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/anatomy/compile/compile_report.h"
#include "artus/anatomy/compile/compile_surfaces.h"
#include "artus/anatomy/compile/region_labels.h"

namespace artus {

/// Fills the measured part of `report` (structures: filler first, then file order; quality; counts)
/// from the finished mesh. Volumes expected of a structure are integrals over its field.
/// Cost: samples of all fields, and four exact distances for each interface.
void measure_joint(const TetMesh& mesh, const RegionLabels& labels,
                   const PreparedSurfaces& surfaces, CompileReport& report);

}  // namespace artus
