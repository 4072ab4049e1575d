// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <vector>

#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/anatomy/compile/labels/distance_field.h"

namespace artus {

/// A point on the boundary between two regions.
struct BoundarySeed {
  Vec3 point = Vec3::Zero();
  RegionId from = 0;
  RegionId to = 0;
};

/// Points on every boundary of a labelling: where the edges of a grid of the given spacing cross
/// it, found by bisection. A part of a region thicker than the spacing cannot be missed.
/// Cost: one label for each grid point, on all threads; the order does not depend on them.
[[nodiscard]] std::vector<BoundarySeed> find_boundary_seeds(
    const std::function<RegionId(const Vec3&)>& label, const Box& box, double spacing);

/// Keeps seeds that are at least `distance(seed)` from all kept before, visited in a fixed
/// scattered order. `largest` bounds what `distance` returns.
[[nodiscard]] std::vector<BoundarySeed> thin_seeds(
    const std::vector<BoundarySeed>& seeds,
    const std::function<double(const BoundarySeed&)>& distance, double largest);

}  // namespace artus
