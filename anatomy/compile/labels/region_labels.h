// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/anatomy/compile/labels/distance_field.h"

namespace artus {

/// Signed distance to the region of interest's boundary, negative inside, m.
[[nodiscard]] double signed_distance(const RegionOfInterest& roi, const Vec3& p);

/// For each block of a box, the layers that can hold a point of it, in priority order, and whether
/// it lies deep in the body.
struct LayerIndex {
  Box box;
  double edge = 0;  ///< m, of a block; 0: no index
  std::array<int, 3> blocks{0, 0, 0};
  std::vector<std::uint8_t> meshed;  ///< (n_blocks) 1: all of it in body and region of interest
  std::vector<std::uint32_t> first;  ///< (n_blocks + 1) into layers
  std::vector<std::uint16_t> layers;
};

/// Which region every point of space belongs to: the layers in priority order, the filler in what
/// they leave of the body, outside and beyond around it. A pure function of position, so the
/// regions can neither overlap nor leave gaps.
struct RegionLabels {
  struct Layer {
    RegionId region = 0;
    DistanceField field;
  };

  DistanceField body;
  RegionId filler = kFirstRegion;
  std::vector<Layer> layers;  ///< first wins
  std::optional<RegionOfInterest> region_of_interest;

  LayerIndex index;  ///< speeds up at(); the answers are the same without it

  /// Makes the index over `box`. Requires: body and layers complete. Cost: blocks times layers.
  void make_index(const Box& box);

  /// The region at `p`. Cost: tens of nanoseconds for each layer whose surface is near.
  [[nodiscard]] RegionId at(const Vec3& p) const;

  /// Signed distance to the surface that separates two regions there: the field of whichever of
  /// them comes first in priority, so that it is negative in that one.
  [[nodiscard]] double separation(RegionId a, RegionId b, const Vec3& p) const;

  /// The layer of a region, or null for filler, outside and beyond.
  [[nodiscard]] const Layer* layer_of(RegionId region) const;
};

}  // namespace artus
