// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/detail/soft/cage/averaging.h"
#include "artus/detail/soft/cage/cage.h"
#include "artus/detail/soft/cage/material.h"

namespace artus {

/// A point of the cage's map: its displacement is a sum over nodes and points of columns.
struct MapPlace {
  std::array<std::uint32_t, 8> points{};
  std::array<float, 8> weights{};
};

/// Which tissue lies where inside the cubes that hold several: columns along z of frame C, at most
/// 1.5 mm apart, cut at the tissues' borders. Neighbouring cubes share the columns of their common
/// side. Between four columns and two levels of theirs the map is interpolated, so that it is the
/// cage's where nothing is cut. Made once with the cage; immutable.
class LayerMap {
 public:
  /// What the map knows of a material.
  struct Kind {
    double compliance = 0;  ///< 1/Pa, of its stretch along the column; 0: bone, rigid
    double least = 0;       ///< of its length at its own volume that is left at the least
    bool tissue = false;    ///< false: air, gel
    bool drains = false;    ///< `least` is of its length at rest
  };
  /// A line along z through a cube; its points are [first, first + size), the first and the last
  /// on the cube's faces.
  struct Column {
    std::uint32_t cell = 0;  ///< one of those that have it
    float x = 0;             ///< of the cube's edge, 0..1
    float y = 0;
    std::uint32_t first = 0;
    std::uint32_t size = 2;  ///< 2: stretched all alike
    [[nodiscard]] bool cut() const noexcept { return size > 2; }
  };

  LayerMap() = default;
  /// `mixtures`: of each cell of the cage.
  LayerMap(const Cage& cage, const MaterialField& field, std::span<const CellMixture> mixtures);

  [[nodiscard]] std::span<const Column> columns() const noexcept { return columns_; }
  [[nodiscard]] std::size_t n_points() const noexcept { return levels_.size(); }
  /// Where a column's points are, of the cube's edge (n_points), and the layer above each.
  [[nodiscard]] std::span<const float> levels() const noexcept { return levels_; }
  [[nodiscard]] const Kind& kind_above(std::uint32_t point) const noexcept {
    return kinds_[kind_above_[point]];
  }

  /// 1 over the number of cubes that have a node (n_nodes).
  [[nodiscard]] std::span<const double> shares_at_nodes() const noexcept {
    return shares_at_nodes_;
  }

  /// Whether a cell has a cut column; -1 has none.
  [[nodiscard]] bool cuts(std::int32_t cell) const noexcept {
    return cell >= 0 && cube_of_[static_cast<std::size_t>(cell)] >= 0;
  }

  /// Four columns around a place in a cube, x fastest, and where between them it lies.
  struct Around {
    std::array<std::uint32_t, 4> columns{};
    Vec3 low = Vec3::Zero();  ///< of the part between them, of the cube's edge; z as the cube's
    double width = 1;         ///< of that part, of the cube's edge
    double x = 0;             ///< 0..1 between them
    double y = 0;
  };
  /// False where none of the four is cut: the cage's own map holds there. `s`: place in the cube,
  /// 0..1.
  [[nodiscard]] bool around(std::int32_t cell, const Vec3& s, Around& out) const noexcept;
  /// The column's layer around level `s`: its lower point.
  [[nodiscard]] std::uint32_t below(const Column& column, double s) const noexcept {
    std::uint32_t k = column.first;
    const std::uint32_t last = column.first + column.size - 2;
    while (k < last && s >= static_cast<double>(levels_[k + 1])) ++k;
    return k;
  }
  /// The point's shares; points of columns stand behind the cage's nodes.
  [[nodiscard]] MapPlace place(const Cage& cage, const CagePlace& place) const;

 private:
  struct Cube {
    std::uint16_t across = 1;  ///< columns but one along x, and along y
    std::size_t first = 0;     ///< of its columns in `columns_of_`
  };
  class Builder;

  std::vector<Kind> kinds_;  // the first is air
  std::vector<Cube> cubes_;
  std::vector<std::int32_t> cube_of_;      // (n_cells)
  std::vector<std::uint32_t> columns_of_;  // (cubes, across + 1, across + 1), x fastest
  std::vector<Column> columns_;
  std::vector<float> levels_;              // (n_points)
  std::vector<std::uint16_t> kind_above_;  // (n_points)
  std::vector<double> shares_at_nodes_;    // (n_nodes)
};

/// How the tissues inside the cubes share what the cubes are squeezed by, in one state of the
/// nodes. The cube's own displacement stretches all of a column alike. Here each layer keeps its
/// volume, so that it is thinned as much as it is stretched sideways at its middle; bone keeps its
/// length; and what is left over goes to each by its compliance, nearly all of it to fluid that
/// drains. Points move along their column's straight line alone and its ends stay, so that there
/// are no gaps to the next cube and nothing folds.
/// Displacements of the cage's nodes followed by those of the map's points, frame C, m. `u`: of all
/// nodes. Cost: 60 ns a column.
[[nodiscard]] std::vector<Vec3> move_map(const Cage& cage, const LayerMap& map,
                                         std::span<const Vec3> u);

}  // namespace artus
