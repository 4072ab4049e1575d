// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/anatomy/compile/labels/distance_field.h"

namespace artus {

/// Signed distance to the region of interest's boundary, negative inside, m.
[[nodiscard]] double signed_distance(const RegionOfInterest& roi, const Vec3& p);

/// The number (from 1 on) and film of a structure's partition; 0 of none.
[[nodiscard]] std::pair<std::size_t, double> partition_of(const JointFile& file,
                                                          const Structure& structure);

/// For each block of a box, the layers that can hold a point of it, in priority order, and whether
/// it lies deep in the body.
struct LayerIndex {
  Box box;
  double edge = 0;  ///< m, of a block; 0: no index
  std::array<int, 3> blocks{0, 0, 0};
  std::vector<std::uint8_t> meshed;  ///< (n_blocks) 1: all of it in body and region of interest
  std::vector<std::uint8_t> filled;  ///< (n_blocks) 1: the last of its layers holds all of it
  std::vector<std::uint32_t> first;  ///< (n_blocks + 1) into layers
  std::vector<std::uint16_t> layers;
};

/// Which region every point of space belongs to: the layers in priority order, the filler in what
/// they leave of the body, outside and beyond around it. Between two members of a partition (or a
/// member and the body's surface) that are nearer than its film, the nearer one. A pure function of
/// position, so the regions can neither overlap nor leave gaps.
struct RegionLabels {
  struct Layer {
    RegionId region = 0;
    DistanceField field;
    std::size_t partition = 0;  ///< its number; 0: of none
    double film = 0;            ///< m, of the partition
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

  /// The member of a partition that has the film of nothing at `p`; filler where there is none.
  [[nodiscard]] RegionId at_film(const Vec3& p) const;

  /// The layer of a region, or null for filler, outside and beyond.
  [[nodiscard]] const Layer* layer_of(RegionId region) const;
};

}  // namespace artus
