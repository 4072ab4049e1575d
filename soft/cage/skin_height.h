// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <vector>

#include "artus/detail/soft/cage/cage.h"
#include "artus/detail/soft/cage/material.h"

namespace artus {

/// Where the body begins below a probe: its height along z of frame C, on a grid. What liquid lifts
/// off the body that a cage fills moves as the skin does that lies below it. Immutable.
class SkinHeight {
 public:
  SkinHeight() = default;
  /// Looks from the cage's low z side. Cost: a look for each 1.5 mm across, of a step a 0.75 mm.
  SkinHeight(const Cage& cage, const MaterialField& field);

  /// A point of the body, and how its z follows x and y.
  struct Below {
    Vec3 p_C = Vec3::Zero();
    bool lowered = false;           ///< the point lay off the body
    std::array<double, 2> slope{};  ///< dz/dx, dz/dy where it did
  };
  /// The point itself, or one 1 mm above the skin below it; the point itself where there is none.
  /// Continuous over the skin. Cost: some 10 ns.
  [[nodiscard]] Below below(const Vec3& p_C) const noexcept;

 private:
  [[nodiscard]] double at(int x, int y) const noexcept {
    return z_[static_cast<std::size_t>(x) +
              static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(y)];
  }

  Vec3 low_ = Vec3::Zero();
  std::array<int, 2> size_{};  // of the grid's points
  std::vector<double> z_;      // m (size_), x fastest; far below where there is no body
};

}  // namespace artus
