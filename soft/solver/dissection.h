// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "artus/core/geometry.h"

namespace artus {

/// A group of unknown nodes that is eliminated together, and the later nodes it is then coupled to.
struct FrontPlan {
  std::vector<std::uint32_t> own;       ///< nodes, in the order of elimination
  std::vector<std::uint32_t> boundary;  ///< later nodes, in the order of elimination
  std::vector<std::uint32_t> children;  ///< fronts whose remainder this one takes in
};

/// The order of a Cholesky factor by nested dissection with planes: halves first, then the nodes
/// between them. Fronts stand children first; the last one is the root.
struct Dissection {
  std::vector<FrontPlan> fronts;
  std::vector<std::uint32_t> position;  ///< (n_nodes) place of each node in the elimination
};

/// Who is coupled with whom: neighbours of node i in [start[i], start[i + 1]), ascending, without
/// i.
struct NodeGraph {
  std::vector<std::uint32_t> start;
  std::vector<std::uint32_t> neighbours;
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t i) const noexcept {
    return std::span(neighbours).subspan(start[i], start[i + 1] - start[i]);
  }
  [[nodiscard]] std::size_t size() const noexcept { return start.size() - 1; }
};

/// Orders a graph whose nodes lie at `places`. `last` are nodes that stand in the root, ascending:
/// what loads only them is solved there. Deterministic. Cost: about 0.1 s for 5000 nodes.
[[nodiscard]] Dissection dissect(const NodeGraph& graph, std::span<const Vec3> places,
                                 std::span<const std::uint32_t> last);

}  // namespace artus
