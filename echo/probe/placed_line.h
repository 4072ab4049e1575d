// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>

#include "artus/core/geometry.h"
#include "artus/echo/transducer.h"

namespace artus {

/// A scanline as one frame sees it: what the probe's pose makes of it, computed once a frame.
struct PlacedLine {
  int index = 0;
  Scanline line;                     ///< frame P
  Vec3 across = Vec3::UnitX();       ///< frame P, unit: beside the line in the image's plane
  Vec3 origin_J = Vec3::Zero();      ///< m
  Vec3 direction_J = Vec3::UnitZ();  ///< unit
  Vec3 elevation_J = Vec3::UnitY();  ///< unit, across the image's plane
};

/// The `index`-th scanline of a probe at X_JP. Requires: a valid transducer, 0 <= index < n_lines.
[[nodiscard]] PlacedLine place_line(const Transducer& probe, int index, const Pose& X_JP) noexcept;

/// A line's echoes in phase and in quadrature; both spans have one length.
struct EchoSpan {
  std::span<float> re;
  std::span<float> im;

  [[nodiscard]] std::size_t size() const noexcept { return re.size(); }
  [[nodiscard]] EchoSpan part(std::size_t first, std::size_t n) const noexcept {
    return {re.subspan(first, n), im.subspan(first, n)};
  }
};

/// Multiplies sample `i` of a line by `gain`.
inline void scale_sample(EchoSpan line, std::size_t i, float gain) noexcept {
  line.re[i] *= gain;
  line.im[i] *= gain;
}

}  // namespace artus
