// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/anatomy/surfaces/distance_tree.h"

namespace artus {

/// Distances from points spread over one surface to another, weighted by area.
struct DistanceStatistics {
  double mean = 0;          ///< m
  double percentile95 = 0;  ///< m
  double max = 0;           ///< m, of the points; of the surfaces at most their spacing more
};

/// A point of a surface and what it stands for.
struct SurfaceSample {
  Vec3 position = Vec3::Zero();
  double area = 0;  ///< m^2; 0 for a corner, which counts for the maximum alone
};

/// A distance and the area that it stands for.
struct DistanceSample {
  double distance = 0;  ///< m
  double area = 0;      ///< m^2
};

/// Appends the corners of a triangle and the centres of the equal parts it is divided into, none
/// longer than `spacing` (m).
void append_samples(const std::array<Vec3, 3>& corners, double spacing,
                    std::vector<SurfaceSample>& samples);

/// Mean, percentile and maximum; zeros for none. Cost: n log n.
[[nodiscard]] DistanceStatistics compute_statistics(std::vector<DistanceSample> samples);

/// The larger one of each figure.
[[nodiscard]] DistanceStatistics worse_of(const DistanceStatistics& a,
                                          const DistanceStatistics& b) noexcept;

/// How far apart two surfaces are: points spread over the triangles of each, to the other; of the
/// two directions the worse one of each figure. Triangles that both have count as zero. The spacing
/// is a three-hundredth of the first one's box, or what gives a hundred thousand points.
/// Requires: two surfaces with triangles. Cost: a second at most.
[[nodiscard]] DistanceStatistics measure_distance(const SurfaceMesh& a, const SurfaceMesh& b);

}  // namespace artus
