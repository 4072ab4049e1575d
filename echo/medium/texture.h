// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/detail/echo/medium/scatter_field.h"

namespace artus {

/// The fine structure of tissues as a factor on their speckle amplitude: perimysium sheets along
/// muscle fibres, septa in fat, fibrils of tendon, fascicles of nerve. They live
/// in each region's own coordinates, so they follow its fibres and belong to the body.
/// Precomputed tiles of 5 mm and more, each shifted along the fibres against its neighbours, so
/// that the same look does not come again before two tiles deeper and one beside; mean square one.
/// assumed: feature sizes, chosen beside real images (perimysium about 1.6 mm apart, septa 3 mm).
class TissueTexture {
 public:
  /// Cost: tens of ms and 3 MB when `enabled`.
  TissueTexture(std::uint64_t seed, bool enabled);

  /// Whether regions of this kind have a texture at all.
  [[nodiscard]] bool has(TissueKind kind) const noexcept;

  /// Factors for the first `out.size()` steps of a walk through a tissue's own coordinates (see
  /// MaterialPoint) from `place` by `step`, m. Requires: has(kind). Cost: about 1 ns a step.
  void sample(TissueKind kind, const Vec3& place, const Vec3& step,
              std::span<float> out) const noexcept;

 private:
  static constexpr std::size_t kKinds = 8;

  struct Tile {
    std::vector<std::uint8_t> values;  // (2^bits), x fastest, or empty
    std::array<std::uint32_t, 3> bits{};
    float unit = 1;  // factor of one step
  };
  std::array<Tile, kKinds> tiles_;
};

}  // namespace artus
