// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "artus/core/geometry.h"

namespace artus {

/// Yes or no for every voxel, x fastest.
struct VoxelMask {
  std::array<std::size_t, 3> size{0, 0, 0};
  std::vector<std::uint8_t> is_in;  ///< (size[2], size[1], size[0])
};

/// Distance of each voxel's centre to the nearest one whose mask is `what`, m; infinite where there
/// is none. `spacing` is the distance of neighbours along each axis, which are taken as square to
/// each other. Cost: linear. Source: [Felzenszwalb2012].
[[nodiscard]] std::vector<float> distances_to(const VoxelMask& mask, bool what,
                                              const Vec3& spacing);

/// Keeps the largest part that hangs together by faces. Cost: linear.
void keep_largest(VoxelMask& mask);

/// Adds what the mask encloses in a plane of the grid, whichever of the three: a limb that leaves
/// the volume at both ends is filled, too. Cost: linear.
void fill_enclosed(VoxelMask& mask);

/// The mask grown by `out` and shrunk by `in` (m, in < out), so that clefts and hollows narrower
/// than 2 * out are closed; computed on cells of about `cell` and interpolated. What lies beyond
/// the grid is taken as going on. Source: assumed: 16, 8 and 2 mm for a skin around muscles and
/// bones.
[[nodiscard]] VoxelMask closed_hull(const VoxelMask& mask, const Vec3& spacing, double out,
                                    double in, double cell);

}  // namespace artus
