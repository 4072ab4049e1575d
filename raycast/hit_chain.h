// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "artus/detail/core/check.h"
#include "artus/detail/raycast/facet.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Hits nearer to each other than this are one place where the line meets several facets, m. Far
/// below any tissue, far above the rounding of single-precision traversal (about 1e-8 m).
inline constexpr double kClusterWidth = 1e-7;

/// Sorts hits by depth; equal depths by interface, so that the order never depends on traversal.
ARTUS_REALTIME void sort_hits(std::span<Hit> hits) noexcept;

/// True when each hit starts in the region where the one before ends and no two are closer than
/// rounding: the common case, in which the hits are the crossings.
[[nodiscard]] ARTUS_REALTIME bool is_chain(std::span<const Hit> sorted) noexcept;

/// Answers which region is at a depth along the line; a plain function pointer with its state, so
/// that the call allocates nothing.
struct RegionProbe {
  RegionId (*region_at_depth)(const void* state, double depth) noexcept = nullptr;
  const void* state = nullptr;
  [[nodiscard]] RegionId operator()(double depth) const noexcept {
    return region_at_depth(state, depth);
  }
};

/// A repaired chain: every hit, plus at most one unmarked change of region per gap.
struct HitChain {
  std::array<Hit, 2 * kMaxHits + 1> hits;
  std::size_t size;
};

/// The part of the line the hits were gathered on, and whether one of them may have lost its
/// neighbours at an edge.
struct TracedRange {
  double near = 0;  ///< m
  double far = 0;   ///< m
  bool doubtful = false;
};

/// Makes a consistent chain of hits that are not one: several facets met at a shared edge or
/// vertex, a double or missed hit, a grazing touch. Hits within kClusterWidth form a cluster; the
/// region of a gap between clusters is what both sides agree on, otherwise (or when the range is
/// doubtful) what `region_at` finds there; each cluster then keeps the hit (or the pair of hits)
/// that leads from the region before it to the region after it, and nothing when these are the
/// same. Beyond the meshed part the line may leave as "beyond" and come back as "outside" (or the
/// reverse): such a change stands in the middle of its gap with kNoInterface.
/// Requires: `sorted` is sorted and has at most kMaxHits hits.
ARTUS_REALTIME void repair_chain(std::span<const Hit> sorted, const TracedRange& range,
                                 const RegionProbe& region_at, HitChain& out) noexcept;

}  // namespace artus
