// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include "artus/raycast/embree_index.h"

namespace artus {
namespace {

constexpr std::size_t kLeastBlock = 256;  // triangles

Vec3 sum_of(const std::array<Vec3, 3>& corners) noexcept {
  return corners[0] + corners[1] + corners[2];
}

}  // namespace

/// Blocks of neighbours: halves, by the middles along the longest side, of halves. Coordinates are
/// kept block by block, so that fitting one reads one piece of memory.
void EmbreeIndex::make_blocks() {
  std::vector<std::uint32_t> order(facets_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<std::span<std::uint32_t>> blocks{order};
  while (2 * blocks.size() <= kMostBlocks && order.size() / blocks.size() >= 2 * kLeastBlock) {
    std::vector<std::span<std::uint32_t>> halves;
    for (const std::span<std::uint32_t> block : blocks) {
      Eigen::AlignedBox3d box;
      for (const std::uint32_t i : block) box.extend(sum_of(corners(i)));
      Eigen::Index axis = 0;
      box.sizes().maxCoeff(&axis);
      const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const double x = sum_of(corners(a))[axis];
        const double y = sum_of(corners(b))[axis];
        return x < y || (x == y && a < b);
      };
      const std::size_t half = block.size() / 2;
      std::nth_element(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(half),
                       block.end(), before);
      halves.push_back(block.first(half));
      halves.push_back(block.subspan(half));
    }
    blocks = std::move(halves);
  }
  block_of_.resize(facets_.size());
  blocks_at_.assign(vertices_.size(), 0);
  constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
  slots_.assign(vertices_.size(), kNone);
  std::uint32_t next = 0;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    for (const std::uint32_t i : blocks[k]) {
      block_of_[i] = static_cast<std::uint8_t>(k);
      for (const std::uint32_t v : facets_[i].vertices) {
        blocks_at_[v] |= std::uint64_t{1} << k;
        if (slots_[v] == kNone) slots_[v] = next++;
      }
    }
  }
  for (std::uint32_t& slot : slots_) {
    if (slot == kNone) slot = next++;
  }
}

}  // namespace artus
