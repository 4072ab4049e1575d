// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "core/geometry.h"

namespace artus {

/// A straight walk through the scatterer lattice in 16.16 fixed-point cells, one step a sample.
struct LatticeWalk {
  std::array<std::uint32_t, 3> start{};
  std::array<std::uint32_t, 3> step{};
};

/// Scatterers of the body: one complex Gaussian-like amplitude per cell of a fine cubic lattice
/// fixed in frame J, made from a hash of the cell and the seed, so they need no memory and belong
/// to the material, not to the image. The lattice is turned against J by a fixed generic rotation,
/// so that no scan is aligned with it.
class ScatterField {
 public:
  /// Edge of a lattice cell: below the resolution of the finest preset in every direction, m.
  static constexpr double kCell = 0.1e-3;

  explicit ScatterField(std::uint64_t seed);

  /// The walk that starts at `p_J` and advances by `step_J` a sample, both m.
  [[nodiscard]] LatticeWalk make_walk(const Vec3& p_J, const Vec3& step_J) const noexcept;

  /// Adds gain[i] * scatterer(i) to (re, im)[i]; scatterers have zero mean and unit power
  /// E|n|^2 = 1. Requires: the three spans have one length. Cost: about 1 ns a sample with AVX2.
  void add(const LatticeWalk& walk, std::span<const float> gain, std::span<float> re,
           std::span<float> im) const noexcept;

  /// Power of a sum of scatterers along a line at `spacing` (m) weighted by `weights`, over the sum
  /// of squared weights for independent ones: neighbouring samples may share a cell.
  [[nodiscard]] static double axial_power(std::span<const float> weights, double spacing) noexcept;

 private:
  Eigen::Matrix3d R_LJ_;  // joint to lattice, in cells per metre
  std::uint32_t seed_ = 0;
};

}  // namespace artus
