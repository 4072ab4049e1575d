// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/result.h"
#include "artus/detail/anatomy/import/label_volume.h"

namespace artus {

/// The grid of a label map that is made of a joint.
struct LabelGrid {
  Vec3 spacing = Vec3(0.4e-3, 0.4e-3, 0.7e-3);  ///< m, along the grid's axes
  bool is_ras = false;       ///< axes run right, anterior, superior; else left, posterior, superior
  Vec3 turn = Vec3::Zero();  ///< rad, about the body's x, y and z, one after the other
};

/// A joint's regions as voxels.
struct JointLabels {
  LabelVolume volume;                ///< the last segment is the rest of the body, named "body"
  std::vector<std::string> tissues;  ///< (n_segments); kBodyOutline for the last
  bool is_cut = false;               ///< the joint ends within the body: not all of its rim is skin
  bool is_ras = false;               ///< as LabelGrid
};

/// Gives each voxel the region of the tetrahedron that its centre lies in. The grid holds the joint
/// and three voxels of air around it. Its frame is rounded to 1e-6 mm (edges) and 1e-3 mm (origin),
/// which every format keeps. Segments are the joint's structures in the order of their regions,
/// then the filler. Errors: invalid (a spacing that is not from 0.05 to 20 mm, more than 2^29
/// voxels), naming the spacing to take. Cost: linear in voxels and tetrahedra; 2 bytes a voxel.
[[nodiscard]] Result<JointLabels> label_joint(const CompiledJoint& joint, const LabelGrid& grid);

}  // namespace artus
