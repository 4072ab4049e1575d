// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "artus/soft/averaging.h"
#include "artus/soft/cage.h"
#include "artus/soft/material.h"

namespace artus {

/// Which tissue lies where inside the cubes that hold several: a grid of columns along z of frame
/// C, at most 1.5 mm apart, with a sample every 0.19 mm. Made once with the cage; immutable.
class LayerMap {
 public:
  /// What the map knows of a material.
  struct Kind {
    double compliance = 0;  ///< 1/Pa, of its stretch along the column; 0: bone, rigid
    double shear = 0;       ///< Pa; 0: bone, or what drains
    bool tissue = false;    ///< false: air, gel
  };
  /// One cube that holds several.
  struct Cube {
    std::uint32_t cell = 0;
    std::uint16_t across = 1;  ///< columns but one along x, and along y
    std::uint16_t along = 1;   ///< samples of a column
    std::size_t first = 0;     ///< of its samples in `samples`
    std::size_t column = 0;    ///< of its first column
  };

  LayerMap() = default;
  /// `mixtures`: of each cell of the cage.
  LayerMap(const Cage& cage, const MaterialField& field, std::span<const CellMixture> mixtures);

  [[nodiscard]] std::span<const Cube> cubes() const noexcept { return cubes_; }
  /// Number of a cell's cube; -1: of one tissue, or too large.
  [[nodiscard]] std::int32_t cube_of(std::int32_t cell) const noexcept {
    return cell < 0 || cube_of_.empty() ? -1 : cube_of_[static_cast<std::size_t>(cell)];
  }
  [[nodiscard]] const Kind& kind(std::size_t sample) const noexcept {
    return kinds_[samples_[sample]];
  }
  /// Whether a column is stretched all alike: of one tissue, or beside cubes of another size.
  [[nodiscard]] bool even(std::size_t column) const noexcept { return contrast_[column] < 0; }
  /// 0: tissues of one modulus .. 1: of moduli that differ by orders of magnitude.
  [[nodiscard]] double contrast(std::size_t column) const noexcept { return contrast_[column]; }

 private:
  void make_kinds(const MaterialField& field);
  void sample(const Cage& cage, const MaterialField& field, std::uint32_t cell);
  [[nodiscard]] float contrast_of(std::size_t first, std::size_t n) const;

  std::vector<Kind> kinds_;             // the first is air
  std::vector<std::uint16_t> kind_of_;  // (materials)
  std::vector<Cube> cubes_;
  std::vector<std::int32_t> cube_of_;   // (n_cells)
  std::vector<std::uint16_t> samples_;  // (cubes, across + 1, across + 1, along), z fastest
  std::vector<float> contrast_;         // (cubes, across + 1, across + 1), x fastest; -1: even
};

/// How the tissues inside a cube share what the cube is squeezed by, in one state of its nodes. The
/// cube's own displacement stretches all of a column alike; here each layer keeps its volume, so
/// that it is thinned as much as it is stretched sideways where it lies; bone keeps its length; and
/// what is left over goes to each by its compliance, nearly all of it to fluid that drains. Points
/// move along their column's straight line alone and its ends stay, so that there are no gaps to
/// the next cube; columns beside cubes of another size do not take part.
class LayerMotion {
 public:
  LayerMotion() = default;
  /// `u`: displacements of all nodes, frame C. Cost: about 1 ms for a joint.
  LayerMotion(const Cage& cage, const LayerMap& map, std::span<const Vec3> u);

  /// How far along its column, in column lengths, a point goes on, and how that changes per edge
  /// of the cube. Both are zero where a cube has one tissue.
  struct Shift {
    double along = 0;
    Vec3 slope = Vec3::Zero();
  };
  [[nodiscard]] bool layered(std::int32_t cell) const noexcept {
    return map_ != nullptr && map_->cube_of(cell) >= 0 &&
           moved_[static_cast<std::size_t>(map_->cube_of(cell))] != 0;
  }
  /// `s`: place in the cube, 0..1. Requires: layered(cell).
  [[nodiscard]] Shift at(std::int32_t cell, const Vec3& s) const noexcept;
  /// The next level of s_z, up or down, at which a line's way through the layers bends by more
  /// than some um; 0 or 1 where there is none before the cube ends. Requires: layered(cell).
  [[nodiscard]] double next_bend(std::int32_t cell, double s_z, bool up) const noexcept;

 private:
  struct Ends;
  void move(const Cage& cage, std::size_t cube, std::span<const Vec3> u,
            std::span<const Vec3> areas);
  void share(std::size_t first, std::size_t n, const Ends& ends, float* shifts) const noexcept;
  void find_bends(std::size_t cube, double edge);

  const LayerMap* map_ = nullptr;
  std::vector<std::uint8_t> moved_;   // (cubes)
  std::vector<std::size_t> first_;    // (cubes) of its shifts
  std::vector<float> shifts_;         // (cubes, across + 1, across + 1, along + 1), z fastest
  std::vector<std::uint64_t> bends_;  // (cubes) a bit for each level
};

}  // namespace artus
