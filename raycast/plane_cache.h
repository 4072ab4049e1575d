// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "artus/detail/raycast/facet.h"

namespace artus {

/// Planes of facets that moved, kept from query to query: lines near each other meet the same ones.
/// Of one thread and one scene at a time: forget() before queries of another. Answers are the same
/// without it.
class PlaneCache {
 public:
  void forget() noexcept { owner_.fill(0); }
  [[nodiscard]] bool has(std::uint32_t facet) const noexcept {
    return owner_[facet % kSize] == facet + 1;
  }
  /// The plane of a facet, made by `make` when it is not there.
  template <class Make>
  [[nodiscard]] const FacetPlane& plane(std::uint32_t facet, const Make& make) noexcept {
    FacetPlane& kept = planes_[facet % kSize];
    if (!has(facet)) {
      kept = make();
      owner_[facet % kSize] = facet + 1;
    }
    return kept;
  }

 private:
  static constexpr std::size_t kSize = 256;

  std::array<std::uint32_t, kSize> owner_{};  // facet + 1; 0: none
  std::array<FacetPlane, kSize> planes_;
};

}  // namespace artus
