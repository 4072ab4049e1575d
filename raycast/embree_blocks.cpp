// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <map>

#include "artus/raycast/embree_index.h"

namespace artus {

/// A block for the triangles of each group, and one for those between it and groups of larger
/// numbers, so that a group that moves alone leaves most of its neighbours' triangles alone.
void EmbreeIndex::make_blocks(const VertexGrouping& groups) {
  const std::uint32_t still = groups.n;
  const auto group = [&](std::uint32_t v) {
    return v < groups.of.size() ? std::min(groups.of[v], still) : still;
  };
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> known;  // by group, and whether between
  blocks_at_.resize(still);
  for (const auto& [a, b, c] : triangles_) {
    const auto [least, most] = std::minmax({group(a), group(b), group(c)});
    const std::array<std::uint32_t, 2> key{least, least == most ? 0U : 1U};
    const std::uint32_t block =
        known.try_emplace(key, static_cast<std::uint32_t>(known.size())).first->second;
    block_of_.push_back(block);
    for (const std::uint32_t v : {a, b, c}) {
      if (group(v) < still) blocks_at_[group(v)].push_back(block);
    }
  }
  for (std::vector<std::uint32_t>& blocks : blocks_at_) {
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  }
  unfitted_.assign(known.size(), false);
  radii_.assign(still + 1U, 0);
  for (const auto& corners : triangles_) {
    for (const std::uint32_t v : corners)
      radii_[group(v)] = std::max(radii_[group(v)], vertices_[v].norm());
  }
}

}  // namespace artus
