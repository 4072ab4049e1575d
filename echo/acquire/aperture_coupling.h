// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "artus/detail/echo/probe/placed_line.h"
#include "artus/echo/transducer.h"

namespace artus {

/// How well each part of the probe's face is coupled to the skin, turned into what every scanline
/// loses: an echo from depth z travels through the aperture that is in use at z, on the way out and
/// back, so a lifted element blacks out what is shallow below it and dims what is deep.
class ApertureCoupling {
 public:
  explicit ApertureCoupling(const Transducer& transducer) noexcept : transducer_(transducer) {}

  /// `coupling`: any number of equal strips of the footprint from its -x to its +x edge, 1 coupled
  /// .. 0 air; values outside are clamped, NaN counts as air. Empty: coupled everywhere.
  /// Cost: linear; allocates only when there are more strips than ever before.
  void set(std::span<const float> coupling);

  /// Whether every part is fully coupled.
  [[nodiscard]] bool complete() const noexcept { return complete_; }

  /// Coupling of the face where scanline `l` leaves it, 0..1.
  [[nodiscard]] double at_line(int l) const noexcept;

  /// Factor on an echo of scanline `l` from depth `z` (m): the square of the coupled share of the
  /// aperture, which is as wide as the receive F-number asks for and ends at the footprint's edge.
  [[nodiscard]] double gain(int l, double z) const noexcept;

  /// Multiplies a line's samples, `sample_depth` (m) apart, by gain().
  void apply(int l, double sample_depth, EchoSpan line) const noexcept;

  /// Adds what the lens rings by itself where it is dry: the face's own, then its repeats, which
  /// fade within a centimetre. `touches`: whether the line meets the skin at all.
  void add_ringing(int l, bool touches, double sample_depth, std::span<float> re) const noexcept;

 private:
  [[nodiscard]] double integral(double place) const noexcept;
  [[nodiscard]] double place_of(int l) const noexcept;

  Transducer transducer_;
  std::vector<double> sum_;  // (n_strips + 1), coupling summed up from the -x edge
  bool complete_ = true;
};

}  // namespace artus
