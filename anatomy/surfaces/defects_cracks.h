// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "artus/detail/anatomy/surfaces/surface_mesh.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"

namespace artus {

/// Two vertices on open edges that may be one, a < b.
struct CrackPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double distance = 0;  ///< m
};

/// Pairs of vertices on open edges within `width` (m) of each other that are not joined by an
/// edge, sorted by distance, then index. Pairs farther apart than half the shortest open edge at
/// either end are left out, so that the narrow end of a tube is not sewn together. Cost: n log n
/// in the open vertices for widths below their spacing.
[[nodiscard]] std::vector<CrackPair> find_crack_pairs(const SurfaceMesh& mesh,
                                                      const std::vector<EdgeUse>& uses,
                                                      double width);

/// Vertices whose faces form more than one fan (fans joined through edges of any number of faces),
/// ascending.
[[nodiscard]] std::vector<std::uint32_t> find_pinches(const SurfaceMesh& mesh,
                                                      const std::vector<EdgeUse>& uses);

}  // namespace artus
