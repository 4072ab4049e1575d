// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/echo/transducer.h"

namespace artus {

/// How wide the probe listens at each depth, to both sides of a scanline and across the slice.
class BeamProfile {
 public:
  /// Tabulates the beam down to `depth` (m). Requires: a valid transducer.
  BeamProfile(const Transducer& transducer, double depth);

  /// Full width at half maximum of the two-way amplitude along x at depth `z`, m: 0.97 wavelengths
  /// times the F-number of the aperture in use where the transmitted beam is focused; elsewhere the
  /// product of two Gaussian beams, the transmitted one widened by the geometry of its aperture
  /// (assumed: sum of squares).
  [[nodiscard]] double lateral_width(double z) const noexcept;

  /// The same across the slice (y), m, from the diffraction of the lens-focused aperture.
  [[nodiscard]] double elevation_width(double z) const noexcept;

  /// Two-way amplitude at elevation `y` and depth `z` relative to the depth's maximum, 0..1.
  [[nodiscard]] double elevation_amplitude(double y, double z) const noexcept;

  /// What is heard of a round rod of `radius` whose axis is at elevation `y`, over what is heard of
  /// it in the middle, 0..1: its wall lies across the slice. m.
  [[nodiscard]] double elevation_share(double y, double z, double radius) const noexcept;

  /// Largest elevation with a tabulated amplitude, m; beyond it the beam hears nothing.
  [[nodiscard]] double max_elevation() const noexcept { return y_step_ * (n_y_ - 1); }

 private:
  Transducer transducer_;
  double z_step_ = 0;  // m
  double y_step_ = 0;  // m
  int n_z_ = 0;
  int n_y_ = 0;
  std::vector<float> amplitude_;  // (n_z, n_y), y fastest
  std::vector<double> width_;     // (n_z), m
};

}  // namespace artus
