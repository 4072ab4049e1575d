// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/layer_map.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace artus {
namespace {

constexpr double kLargest = 6.5e-3;   // m, edge of a cube that is looked into
constexpr double kAcross = 1.5e-3;    // m between columns
constexpr double kAlong = 0.1875e-3;  // m between samples: no thinner layer is sure to be found
constexpr int kBorderHalvings = 8;    // that find a border between two samples
constexpr double kBeside = 1e-5;      // m, to look across a cube's side
constexpr double kMinFluid = 0.1;     // of its length, what is left of fluid that drains; assumed
constexpr double kMinSolid = 0.3;     // of its length at its own volume, of any other; assumed

bool has_several(const CellMixture& mix) {
  return std::any_of(mix.samples.begin(), mix.samples.end(),
                     [&](int m) { return m != mix.samples.front(); });
}

/// Cells that hold several materials, and those that share a node with one.
std::vector<bool> near_several(const Cage& cage, std::span<const CellMixture> mixtures) {
  const auto cells = cage.cells();
  std::vector<bool> node(cage.nodes().size(), false);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!has_several(mixtures[c])) continue;
    for (const std::uint32_t n : cells[c].nodes) node[n] = true;
  }
  std::vector<bool> near;
  for (const CageCell& cell : cells)
    near.push_back(std::any_of(cell.nodes.begin(), cell.nodes.end(),
                               [&](std::uint32_t n) { return node[n]; }));
  return near;
}

/// Whether a line along z lies in sides of the cube beyond which cubes of another size are.
bool beside_other_size(const Cage& cage, const CageCell& cell, double x, double y) {
  const double edge = cage.edge(cell);
  for (int side = 0; side < 8; ++side) {
    const Vec3 p = cage.low_corner(cell) + Vec3(x + ((side & 1) != 0 ? kBeside : -kBeside),
                                                y + ((side & 2) != 0 ? kBeside : -kBeside),
                                                ((side & 4) != 0 ? 0.75 : 0.25) * edge);
    const std::int32_t other = cage.cell_around(p);
    if (other >= 0 && cage.cells()[static_cast<std::size_t>(other)].span != cell.span) return true;
  }
  return false;
}

}  // namespace

/// Samples the columns of the cubes, each once.
class LayerMap::Builder {
 public:
  Builder(LayerMap& map, const Cage& cage, const MaterialField& field)
      : map_(map), cage_(cage), field_(field) {
    make_kinds();
  }

  void add(std::uint32_t c) {
    const CageCell& cell = cage_.cells()[c];
    Cube cube;
    while (cube.across < 4 && cage_.edge(cell) > 1.01 * kAcross * cube.across) cube.across *= 2;
    cube.first = map_.columns_of_.size();
    bool some = false;
    for (int j = 0; j <= cube.across; ++j) {
      for (int i = 0; i <= cube.across; ++i) {
        const std::uint32_t column = column_at(c, i, j, cube.across);
        some = some || map_.columns_[column].cut();
        map_.columns_of_.push_back(column);
      }
    }
    if (some) {
      map_.cube_of_[c] = static_cast<std::int32_t>(map_.cubes_.size());
      map_.cubes_.push_back(cube);
    } else {
      map_.columns_of_.resize(cube.first);
    }
  }

 private:
  void make_kinds() {
    map_.kinds_.push_back({});
    for (const SoftMaterial& m : field_.materials) {
      Kind kind;
      kind.tissue = true;
      if (!m.hard) {
        kind.drains = m.drain_pressure > 0;
        kind.compliance = 1 / (kind.drains ? m.drain_pressure : m.bulk + 2 * m.shear);
        kind.least = kind.drains ? kMinFluid : kMinSolid;
      }
      const auto same = std::find_if(map_.kinds_.begin(), map_.kinds_.end(), [&](const Kind& k) {
        return k.tissue && k.compliance == kind.compliance && k.drains == kind.drains;
      });
      kind_of_.push_back(static_cast<std::uint16_t>(same - map_.kinds_.begin()));
      if (same == map_.kinds_.end()) map_.kinds_.push_back(kind);
    }
  }

  [[nodiscard]] std::uint16_t kind_at(const Vec3& p) const {
    const int m = field_.at(p);
    return m < 0 ? 0 : kind_of_[static_cast<std::size_t>(m)];
  }

  std::uint32_t column_at(std::uint32_t c, int i, int j, int across) {
    const CageCell& cell = cage_.cells()[c];
    const auto quarters = [&](std::size_t axis, int at) {
      return static_cast<std::uint64_t>(4 * cell.corner[axis] + 4 * cell.span * at / across);
    };
    const std::uint64_t key = quarters(0, i) | quarters(1, j) << 20U |
                              static_cast<std::uint64_t>(cell.corner[2]) << 40U |
                              static_cast<std::uint64_t>(cell.span) << 56U;
    const auto [place, is_new] =
        known_.try_emplace(key, static_cast<std::uint32_t>(map_.columns_.size()));
    if (!is_new) return place->second;
    const double edge = cage_.edge(cell);
    Column column;
    column.cell = c;
    column.x = static_cast<float>(i) / static_cast<float>(across);
    column.y = static_cast<float>(j) / static_cast<float>(across);
    const bool rim = i == 0 || j == 0 || i == across || j == across;
    const Vec3 side(edge * i / across, edge * j / across, 0);
    cut(column, cage_.low_corner(cell) + side, edge,
        !(rim && beside_other_size(cage_, cell, side.x(), side.y())));
    map_.columns_.push_back(column);
    return place->second;
  }

  /// Sets the column's points: its ends and, where it is one run of tissue that has layers, the
  /// borders of these.
  void cut(Column& column, const Vec3& low, double edge, bool may) {
    column.first = static_cast<std::uint32_t>(map_.levels_.size());
    const auto put = [&](double level, std::uint16_t kind) {
      map_.levels_.push_back(static_cast<float>(level));
      map_.kind_above_.push_back(kind);
    };
    const auto at = [&](double level) {
      return kind_at(low + Vec3(0, 0, edge * level));
    };
    const int n = std::max(1, static_cast<int>(std::lround(edge / kAlong)));
    std::uint16_t kind = may ? at(0.5 / n) : std::uint16_t{0};
    put(0, kind);
    for (int k = 1; may && k < n; ++k) {
      double above = (k + 0.5) / n;
      const std::uint16_t next = at(above);
      if (next == kind) continue;
      double below = above - 1.0 / n;
      for (int h = 0; h < kBorderHalvings; ++h) {
        const double middle = 0.5 * (below + above);
        (at(middle) == kind ? below : above) = middle;
      }
      put(0.5 * (below + above), next);
      kind = next;
    }
    const auto begin = map_.kind_above_.begin() + column.first;
    const auto size = map_.kind_above_.end() - begin;
    const auto airs = std::count(begin, map_.kind_above_.end(), 0);
    const auto at_ends = (*begin == 0 ? 1 : 0) + (map_.kind_above_.back() == 0 ? 1 : 0);
    if (airs > at_ends || size - at_ends < 2) {  // air within, or one tissue
      map_.levels_.resize(column.first + 1);
      map_.kind_above_.resize(column.first + 1);
    }
    put(1, 0);
    column.size = static_cast<std::uint32_t>(map_.levels_.size()) - column.first;
  }

  LayerMap& map_;
  const Cage& cage_;
  const MaterialField& field_;
  std::vector<std::uint16_t> kind_of_;  // (materials)
  std::unordered_map<std::uint64_t, std::uint32_t> known_;
};

LayerMap::LayerMap(const Cage& cage, const MaterialField& field,
                   std::span<const CellMixture> mixtures) {
  Builder builder(*this, cage, field);
  const auto cells = cage.cells();
  cube_of_.assign(cells.size(), -1);
  if (kinds_.size() < 3 || cells.empty()) return;
  const auto [least, largest] =
      std::minmax_element(cells.begin(), cells.end(),
                          [](const CageCell& a, const CageCell& b) { return a.span < b.span; });
  shares_at_nodes_.assign(cage.nodes().size(), 0);
  for (const CageCell& cell : cells) {
    for (const std::uint32_t n : cell.nodes) ++shares_at_nodes_[n];
  }
  for (double& share : shares_at_nodes_) share = 1 / std::max(1.0, share);
  const std::vector<bool> near = near_several(cage, mixtures);
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    const bool coarsest = least->span < largest->span && cells[c].span == largest->span;
    if (near[c] && !coarsest && cage.edge(cells[c]) < kLargest) builder.add(c);
  }
}

bool LayerMap::around(std::int32_t cell, const Vec3& s, Around& out) const noexcept {
  if (!cuts(cell)) return false;
  const Cube& cube = cubes_[static_cast<std::size_t>(cube_of_[static_cast<std::size_t>(cell)])];
  const double n = cube.across;
  const double i = std::clamp(std::floor(s.x() * n), 0.0, n - 1);
  const double j = std::clamp(std::floor(s.y() * n), 0.0, n - 1);
  const std::size_t row = cube.across + 1U;
  const std::uint32_t* at =
      &columns_of_[cube.first + static_cast<std::size_t>(i) + row * static_cast<std::size_t>(j)];
  out.columns = {at[0], at[1], at[row], at[row + 1]};
  if (std::none_of(out.columns.begin(), out.columns.end(),
                   [&](std::uint32_t c) { return columns_[c].cut(); }))
    return false;
  out.width = 1 / n;
  out.low = Vec3(i / n, j / n, 0);
  out.x = s.x() * n - i;
  out.y = s.y() * n - j;
  return true;
}

MapPlace LayerMap::place(const Cage& cage, const CagePlace& place) const {
  MapPlace out;
  if (place.cell < 0) return out;
  const CageCell& cell = cage.cells()[static_cast<std::size_t>(place.cell)];
  const auto& w = place.weights;
  const Vec3 s(w[1] + w[3] + w[5] + w[7], w[2] + w[3] + w[6] + w[7], w[4] + w[5] + w[6] + w[7]);
  Around four;
  if (!around(place.cell, s, four)) {
    out.points = cell.nodes;
    for (std::size_t a = 0; a < 8; ++a) out.weights[a] = static_cast<float>(w[a]);
    return out;
  }
  const auto n_nodes = static_cast<std::uint32_t>(cage.nodes().size());
  for (std::size_t c = 0; c < 4; ++c) {
    const std::uint32_t k = below(columns_[four.columns[c]], s.z());
    const double from = static_cast<double>(levels_[k]);
    const double up = (s.z() - from) / (static_cast<double>(levels_[k + 1]) - from);
    const double share =
        ((c & 1U) != 0 ? four.x : 1 - four.x) * ((c & 2U) != 0 ? four.y : 1 - four.y);
    out.points[c] = n_nodes + k;
    out.points[c + 4] = n_nodes + k + 1;
    out.weights[c] = static_cast<float>(share * (1 - up));
    out.weights[c + 4] = static_cast<float>(share * up);
  }
  return out;
}

}  // namespace artus
