// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "echo/region_acoustics.h"
#include "echo/scatter_field.h"

namespace artus {

/// The fine structure of tissues as a factor on their speckle amplitude: perimysium sheets along
/// muscle fibres, septa in fat, fibrils of tendon, fascicles of nerve. Fixed in frame J and turned
/// to each region's fibre axis. Periodic, precomputed, mean square one.
/// assumed: feature sizes, chosen beside real images (perimysium about 2 mm apart, fat septa 4 mm).
class TissueTexture {
 public:
  explicit TissueTexture(std::uint64_t seed);

  /// Whether regions of this kind have a texture at all.
  [[nodiscard]] bool has(TissueKind kind) const noexcept;

  /// The walk through the tile of `region`'s kind for a beam at `p_J` advancing by `step_J`, m.
  [[nodiscard]] LatticeWalk make_walk(const RegionAcoustics& region, const Vec3& p_J,
                                      const Vec3& step_J) const noexcept;

  /// Factors at the first `out.size()` steps of a walk through the tile of `kind`.
  /// Requires: has(kind).
  void sample(TissueKind kind, const LatticeWalk& walk, std::span<float> out) const noexcept;

 private:
  static constexpr std::uint32_t kBits = 6;
  static constexpr std::uint32_t kMask = (1U << kBits) - 1;
  static constexpr std::size_t kKinds = 8;

  struct Tile {
    std::vector<std::uint8_t> values;  // (64, 64, 64), x fastest, or empty
    float unit = 1;                    // factor of one step
  };
  std::array<Tile, kKinds> tiles_;
};

}  // namespace artus
