// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/detail/echo/probe/placed_line.h"

namespace artus {

/// A straight walk through a lattice in 16.16 fixed-point cells, one step a sample.
struct LatticeWalk {
  std::array<std::uint32_t, 3> start{};
  std::array<std::uint32_t, 3> step{};
};

/// `cells` in 16.16 fixed point; whole turns of 65536 cells drop out.
[[nodiscard]] inline std::uint32_t to_fixed_cells(double cells) noexcept {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(cells * 65536));
}

/// How large a piece of tissue answers a beam as one scatterer, m. A beam cannot tell smaller ones
/// apart; several must lie in every resolution cell.
struct ScattererSize {
  double lateral = 0.16e-3;   ///< across scanlines
  double elevation = 0.4e-3;  ///< across the image plane
  double axial = 0.06e-3;     ///< along the beam
};

/// The scatterers that one scanline sees: a lattice, or a few that blend into each other.
struct ScatterView {
  struct Lattice {
    Eigen::Matrix3d cells_J;  ///< rows: lateral, elevation, axial cells per metre of frame J
    std::uint32_t seed = 0;
    float weight = 1;
  };
  static constexpr std::size_t kMax = 6;
  std::array<Lattice, kMax> lattices;
  std::size_t size = 0;
};

/// A straight part of the path that a line's samples take through the tissue as it was at rest.
struct ScatterPiece {
  std::size_t begin = 0;       ///< sample
  std::size_t end = 0;         ///< the first behind it
  Vec3 p_J = Vec3::Zero();     ///< m, at `begin`
  Vec3 step_J = Vec3::Zero();  ///< m per sample
};

/// Room for the walk of one line's samples through a lattice, in cells; reused from line to line.
class ScatterRoom {
 public:
  /// For lines of `n` samples.
  void resize(std::size_t n);

 private:
  friend class ScatterField;
  std::array<std::vector<std::uint32_t>, 3> cells_;  // (n and some more) 16.16 fixed point
};

/// Scatterers of the body: a complex Gaussian-like amplitude for every cell of a lattice fixed in
/// frame J, made from a hash of the cell and the seed, so they need no memory and belong to the
/// material, not to the image. Cells are as long in each direction as the beam is blind, so that
/// they must be turned with the view: 40 elevation axes and steps of 15 degrees within the plane
/// are fixed in the body, and the nearest is taken, blending over the last degree. Real speckle
/// changes alike when the beam's angle leaves its aperture. Rows of cells are staggered, so a probe
/// that moves by part of a cell changes that part of the scatterers; along the beam neighbours
/// blend into each other at constant power: speckle moves with the tissue by parts of a sample and
/// without a jump.
class ScatterField {
 public:
  explicit ScatterField(std::uint64_t seed, const ScattererSize& size = {});

  /// The scatterers for a beam along `direction_J` whose slice is thick along `elevation_J`
  /// (units).
  [[nodiscard]] ScatterView make_view(const Vec3& direction_J,
                                      const Vec3& elevation_J) const noexcept;

  /// Adds gain[i] * scatterer(i) to (re, im)[i] for a walk from `p_J` by `step_J` a sample, m;
  /// scatterers have zero mean and unit power E|n|^2 = 1. Requires: the three spans have one
  /// length. Cost: about 1.7 ns a sample and lattice with AVX2.
  static void add(const ScatterView& view, const Vec3& p_J, const Vec3& step_J,
                  std::span<const float> gain, std::span<float> re, std::span<float> im) noexcept;

  /// The same for a line of many pieces: adds to the samples that they cover. Requires: pieces that
  /// ascend, apart from each other, within the spans; room for as many samples; `gain` as long.
  /// Cost: as above and some 20 ns a piece and lattice.
  static void add(const ScatterView& view, std::span<const ScatterPiece> pieces,
                  std::span<const float> gain, ScatterRoom& room, std::span<float> re,
                  std::span<float> im) noexcept;

  /// How many more sets of scatterers a compound image averages over.
  static constexpr std::size_t kMoreSets = 2;
  using MoreSets = std::array<EchoSpan, kMoreSets>;

  /// The same, and to each of `more` what another set of scatterers in the same cells, independent
  /// of this one, would have given instead: the difference between the two.
  static void add(const ScatterView& view, std::span<const ScatterPiece> pieces,
                  std::span<const float> gain, ScatterRoom& room, EchoSpan echoes,
                  const MoreSets& more) noexcept;

  /// Share of samples `distance` apart (m) that lie in the same cell of size `cell`: their
  /// correlation.
  [[nodiscard]] static double shared(double distance, double cell) noexcept;

  /// Correlation of samples `distance` apart (m) along the beam, where scatterers of cells `cell`
  /// long blend into each other.
  [[nodiscard]] static double shared_axially(double distance, double cell) noexcept;

  [[nodiscard]] const ScattererSize& size() const noexcept { return size_; }

 private:
  struct Axis {
    Vec3 elevation;
    Vec3 reference;  // where angles within the plane count from
  };
  ScattererSize size_;
  std::uint64_t seed_;
  std::vector<Axis> axes_;
};

/// Adds gain[i] times white complex noise of unit power to line `line`, the same in each call.
void add_white_noise(std::uint64_t seed, int line, std::span<const float> gain, std::span<float> re,
                     std::span<float> im) noexcept;

}  // namespace artus
