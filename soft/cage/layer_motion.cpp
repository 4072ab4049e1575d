// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/soft/cage/layer_map.h"

namespace artus {
namespace {

constexpr double kMinColumn = 0.05;  // a column pressed flatter is stretched all alike
constexpr std::size_t kMaxLayers = 32;

/// What a unit area across z becomes, at each node, as a vector: the mean of its cubes'.
std::vector<Vec3> node_areas(const Cage& cage, const LayerMap& map, std::span<const Vec3> u) {
  std::vector<Vec3> areas(u.size(), Vec3::Zero());
  for (const CageCell& cell : cage.cells()) {
    const double per_edge = 1 / cage.edge(cell);
    std::array<Vec3, 4> x;  // along the edges in x, and in y
    std::array<Vec3, 4> y;
    for (std::size_t e = 0; e < 4; ++e) {
      x[e] = Vec3::UnitX() + per_edge * (u[cell.nodes[2 * e + 1]] - u[cell.nodes[2 * e]]);
      const std::size_t a = (e & 1U) + 2 * (e & 2U);
      y[e] = Vec3::UnitY() + per_edge * (u[cell.nodes[a + 2]] - u[cell.nodes[a]]);
    }
    for (std::size_t a = 0; a < 8; ++a)
      areas[cell.nodes[a]] += x[a >> 1U].cross(y[(a & 1U) + (a >> 1U & 2U)]);
  }
  for (std::size_t n = 0; n < areas.size(); ++n) areas[n] *= map.shares_at_nodes()[n];
  return areas;
}

// Without initialisers: clearing the room for a column's layers would cost more than its motion.
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): `share` writes all of those it is given
struct Layer {
  double thickness;  // of the cube's edge
  double stretch;
  double compliance;  // how much more it is stretched by a tension
  double least;       // that stretch can be
};

/// Stretches the layers so that together they are `length` long.
void balance(std::span<Layer> layers, double length) noexcept {
  for (bool again = true; again;) {
    double missing = length;
    double gives = 0;
    for (const Layer& layer : layers) {
      missing -= layer.thickness * layer.stretch;
      gives += layer.thickness * layer.compliance;
    }
    if (!(gives > 0)) return;
    again = false;
    const double tension = missing / gives;
    for (Layer& layer : layers) {
      if (layer.compliance > 0 && layer.stretch + tension * layer.compliance < layer.least) {
        layer.stretch = layer.least;
        layer.compliance = 0;
        again = true;
      }
    }
    if (again) continue;
    for (Layer& layer : layers) layer.stretch += tension * layer.compliance;
  }
}

/// What a column's ends do.
struct Ends {
  Vec3 low;  // m, displacement
  Vec3 high;
  double area_low = 1;  // of an area across it, over that at rest
  double area_high = 1;
  double length = 1;  // of the column across the layers, over that at rest
};

/// Displacements of a column's inner points.
class ColumnMotion {
 public:
  ColumnMotion(const LayerMap& map, const LayerMap::Column& column) : map_(map), column_(column) {
    first_ = column.first;
    last_ = column.first + column.size - 1;  // not a layer's lower point
    if (!map.kind_above(first_).tissue) ++first_;
    if (!map.kind_above(last_ - 1).tissue) --last_;
  }

  void move(const Ends& ends, double edge, std::span<Vec3> points) const noexcept {
    std::array<Layer, kMaxLayers> layers;
    const std::size_t n = last_ - first_;
    const double begin = level(first_);
    const double run = level(last_) - begin;
    bool even =
        n > kMaxLayers || !(std::min({ends.area_low, ends.area_high, ends.length}) > kMinColumn);
    if (!even) share(ends, std::span(layers.data(), n), run);
    double sum = 0;
    for (std::size_t k = 0; !even && k < n; ++k) sum += layers[k].thickness * layers[k].stretch;
    even = even || !(sum > 0);
    const Vec3 direction = ends.high - ends.low;
    double at = 0;
    for (std::uint32_t k = column_.first + 1; k + 1 < column_.first + column_.size; ++k) {
      const double s = level(k);
      if (k > first_ && k <= last_ && !even)
        at += layers[k - 1 - first_].thickness * layers[k - 1 - first_].stretch / sum;
      const double along = even || k <= first_ || k >= last_ ? s : begin + run * at;
      points[k - column_.first] = ends.low + along * direction + Vec3(0, 0, edge * (along - s));
    }
  }

 private:
  [[nodiscard]] double level(std::uint32_t k) const noexcept {
    return static_cast<double>(map_.levels()[k]);
  }

  /// The stretch of each layer: by its own volume, and of what is left its share by compliance, but
  /// none thinner than it can be.
  void share(const Ends& ends, std::span<Layer> layers, double run) const noexcept {
    for (std::size_t k = 0; k < layers.size(); ++k) {
      const auto point = first_ + static_cast<std::uint32_t>(k);
      const LayerMap::Kind& kind = map_.kind_above(point);
      Layer& layer = layers[k];
      layer = {level(point + 1) - level(point), 1, 0, 0};
      if (!(kind.compliance > 0)) continue;
      const double middle = 0.5 * (level(point) + level(point + 1));
      layer.stretch = 1 / std::lerp(ends.area_low, ends.area_high, middle);
      layer.compliance = layer.stretch * kind.compliance;
      layer.least = kind.least * (kind.drains ? 1 : std::min(1.0, layer.stretch));
    }
    balance(layers, run * ends.length);
  }

  const LayerMap& map_;
  const LayerMap::Column& column_;
  std::uint32_t first_ = 0;  // lower point of the lowest layer of tissue
  std::uint32_t last_ = 0;   // upper point of the highest
};

Vec3 bilinear(const std::array<Vec3, 4>& c, double x, double y) noexcept {
  return (1 - y) * ((1 - x) * c[0] + x * c[1]) + y * ((1 - x) * c[2] + x * c[3]);
}

}  // namespace

std::vector<Vec3> move_map(const Cage& cage, const LayerMap& map, std::span<const Vec3> u) {
  std::vector<Vec3> all;
  all.reserve(u.size() + map.n_points());
  all.assign(u.begin(), u.end());
  all.resize(u.size() + map.n_points());
  if (map.columns().empty()) return all;
  const std::vector<Vec3> areas = node_areas(cage, map, u);
  for (const LayerMap::Column& column : map.columns()) {
    const CageCell& cell = cage.cells()[column.cell];
    const auto x = static_cast<double>(column.x);
    const auto y = static_cast<double>(column.y);
    const auto at_end = [&](std::size_t end, const auto& value) {
      std::array<Vec3, 4> c;
      for (std::size_t a = 0; a < 4; ++a) c[a] = value(cell.nodes[end + a]);
      return bilinear(c, x, y);
    };
    const auto moved = [&](std::uint32_t n) {
      return u[n];
    };
    Ends ends;
    ends.low = at_end(0, moved);
    ends.high = at_end(4, moved);
    const std::span<Vec3> points = std::span(all).subspan(u.size() + column.first, column.size);
    points.front() = ends.low;
    points.back() = ends.high;
    if (!column.cut()) continue;
    const auto area = [&](std::uint32_t n) {
      return areas[n];
    };
    const Vec3 low = at_end(0, area);
    const Vec3 high = at_end(4, area);
    const double edge = cage.edge(cell);
    ends.area_low = low.norm();
    ends.area_high = high.norm();
    ends.length =
        (Vec3::UnitZ() + (ends.high - ends.low) / edge).dot(Vec3(low + high).normalized());
    ColumnMotion(map, column).move(ends, edge, points);
  }
  return all;
}

}  // namespace artus
