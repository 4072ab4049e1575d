// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include "anatomy/distance_field.h"
#include "anatomy/joint.h"
#include "anatomy/tet_mesh.h"

namespace artus {

/// Signed distance to the region of interest's boundary, negative inside, m.
[[nodiscard]] double signed_distance(const RegionOfInterest& roi, const Vec3& p);

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

  /// The region at `p`. Cost: about ten nanoseconds for each layer.
  [[nodiscard]] RegionId at(const Vec3& p) const;

  /// Signed distance to the surface that separates two regions there: the field of whichever of
  /// them comes first in priority, so that it is negative in that one.
  [[nodiscard]] double separation(RegionId a, RegionId b, const Vec3& p) const;

  /// The layer of a region, or null for filler, outside and beyond.
  [[nodiscard]] const Layer* layer_of(RegionId region) const;
};

}  // namespace artus
