// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/layer_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace artus {
namespace {

constexpr double kLargest = 6.5e-3;   // m, edge of a cube that is looked into
constexpr double kAcross = 1.5e-3;    // m between columns
constexpr double kAlong = 0.1875e-3;  // m between samples
constexpr std::size_t kMostSamples = 64;
constexpr double kBeside = 1e-5;       // m, to look across a cube's side
constexpr double kLeastFluid = 0.1;    // of its length, what is left of fluid that drains; assumed
constexpr double kLeastSolid = 0.3;    // of its length at its own volume, of any other; assumed
constexpr double kLeastColumn = 0.05;  // a column pressed flatter is stretched all alike
constexpr double kStraight = 4e-6;     // m that a line may be off between two bends
constexpr double kStill = 1e-9;        // m

std::uint16_t parts(double edge, double size, double most) {
  return static_cast<std::uint16_t>(std::clamp(std::round(edge / size), 1.0, most));
}

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

/// Whether a vertical line of a cube lies along cubes of another size.
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

Vec3 bilinear(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double x, double y) {
  return (1 - y) * ((1 - x) * a + x * b) + y * ((1 - x) * c + x * d);
}

/// What a unit area across z becomes, at each node, as a vector: the mean of its cubes'.
std::vector<Vec3> node_areas(const Cage& cage, std::span<const Vec3> u) {
  std::vector<Vec3> areas(u.size(), Vec3::Zero());
  std::vector<int> count(u.size(), 0);
  for (const CageCell& cell : cage.cells()) {
    const double edge = cage.edge(cell);
    for (std::size_t a = 0; a < 8; ++a) {
      const auto along = [&](std::size_t bit) {
        return Vec3((u[cell.nodes[a | bit]] - u[cell.nodes[a & ~bit]]) / edge);
      };
      areas[cell.nodes[a]] += (Vec3::UnitX() + along(1)).cross(Vec3::UnitY() + along(2));
      ++count[cell.nodes[a]];
    }
  }
  for (std::size_t n = 0; n < areas.size(); ++n) {
    if (count[n] > 0) areas[n] /= count[n];
  }
  return areas;
}

/// A run of samples of one kind.
struct Layer {
  const LayerMap::Kind* kind = nullptr;
  std::size_t begin = 0;
  std::size_t end = 0;
  double stretch = 1;
  double give = 0;   // how much more it is stretched by a tension
  double least = 0;  // that stretch can be
  [[nodiscard]] double samples() const noexcept { return static_cast<double>(end - begin); }
};

/// Stretches the layers so that together they are `length` samples long.
void balance(std::span<Layer> layers, double length) noexcept {
  for (bool again = true; again;) {
    double sum = 0;
    double gives = 0;
    for (const Layer& layer : layers) {
      sum += layer.samples() * layer.stretch;
      gives += layer.samples() * layer.give;
    }
    if (!(gives > 0)) return;
    again = false;
    const double tension = (length - sum) / gives;
    for (Layer& layer : layers) {
      if (layer.give > 0 && layer.stretch + tension * layer.give < layer.least) {
        layer.stretch = layer.least;
        layer.give = 0;
        again = true;
      }
    }
    if (again) continue;
    for (Layer& layer : layers) layer.stretch += tension * layer.give;
  }
}

}  // namespace

void LayerMap::make_kinds(const MaterialField& field) {
  kinds_.push_back({});
  for (const SoftMaterial& m : field.materials) {
    Kind kind;
    kind.tissue = true;
    if (!m.hard && m.drain_pressure > 0) {
      kind.compliance = 1 / m.drain_pressure;
    } else if (!m.hard) {
      kind.compliance = 1 / (m.bulk + 2 * m.shear);
      kind.shear = m.shear;
    }
    const auto same = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& k) {
      return k.tissue && k.compliance == kind.compliance && k.shear == kind.shear;
    });
    kind_of_.push_back(static_cast<std::uint16_t>(same - kinds_.begin()));
    if (same == kinds_.end()) kinds_.push_back(kind);
  }
}

LayerMap::LayerMap(const Cage& cage, const MaterialField& field,
                   std::span<const CellMixture> mixtures) {
  make_kinds(field);
  const auto cells = cage.cells();
  if (kinds_.size() < 3 || cells.empty()) return;
  const auto [least, largest] =
      std::minmax_element(cells.begin(), cells.end(),
                          [](const CageCell& a, const CageCell& b) { return a.span < b.span; });
  const std::vector<bool> near = near_several(cage, mixtures);
  cube_of_.assign(cells.size(), -1);
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    const bool coarsest = least->span < largest->span && cells[c].span == largest->span;
    if (near[c] && !coarsest && cage.edge(cells[c]) < kLargest) sample(cage, field, c);
  }
}

/// Takes the samples of a cell's columns, and drops them when no column has several tissues.
void LayerMap::sample(const Cage& cage, const MaterialField& field, std::uint32_t c) {
  const CageCell& cell = cage.cells()[c];
  const double edge = cage.edge(cell);
  Cube cube;
  cube.cell = c;
  cube.across = parts(edge, kAcross, 8);
  cube.along = parts(edge, kAlong, kMostSamples);
  cube.first = samples_.size();
  cube.column = contrast_.size();
  bool some = false;
  for (int j = 0; j <= cube.across; ++j) {
    for (int i = 0; i <= cube.across; ++i) {
      const double x = edge * i / cube.across;
      const double y = edge * j / cube.across;
      const std::size_t first = samples_.size();
      for (int k = 0; k < cube.along; ++k) {
        const int m = field.at(cage.low_corner(cell) + Vec3(x, y, edge * (k + 0.5) / cube.along));
        samples_.push_back(m < 0 ? 0 : kind_of_[static_cast<std::size_t>(m)]);
      }
      float contrast = contrast_of(first, cube.along);
      const bool rim = i == 0 || j == 0 || i == cube.across || j == cube.across;
      if (contrast >= 0 && rim && beside_other_size(cage, cell, x, y)) contrast = -1;
      some = some || contrast >= 0;
      contrast_.push_back(contrast);
    }
  }
  if (some) {
    cube_of_[c] = static_cast<std::int32_t>(cubes_.size());
    cubes_.push_back(cube);
  } else {
    samples_.resize(cube.first);
    contrast_.resize(cube.column);
  }
}

/// -1 for a column of one tissue.
float LayerMap::contrast_of(std::size_t first, std::size_t n) const {
  std::uint16_t one = 0;
  bool several = false;
  double count = 0;
  double shear = 0;
  double compliance = 0;
  for (std::size_t k = first; k < first + n; ++k) {
    if (samples_[k] == 0) continue;
    several = several || (one != 0 && samples_[k] != one);
    one = samples_[k];
    if (kinds_[one].shear <= 0) continue;
    count += 1;
    shear += kinds_[one].shear;
    compliance += 1 / kinds_[one].shear;
  }
  if (!several) return -1;
  return count > 0 ? static_cast<float>(std::max(0.0, 1 - count * count / (shear * compliance)))
                   : 0;
}

/// What a column's ends do.
struct LayerMotion::Ends {
  double area_low = 1;   ///< of an area across it, over that at rest
  double area_high = 1;  ///< the same at its other end
  double length = 1;     ///< of the column across the layers, over that at rest
  double contrast = 0;
};

LayerMotion::LayerMotion(const Cage& cage, const LayerMap& map, std::span<const Vec3> u) {
  if (map.cubes().empty()) return;
  map_ = &map;
  std::size_t n = 0;
  for (const LayerMap::Cube& cube : map.cubes()) {
    first_.push_back(n);
    n += static_cast<std::size_t>((cube.across + 1) * (cube.across + 1) * (cube.along + 1));
  }
  shifts_.assign(n, 0.0F);
  moved_.assign(map.cubes().size(), 0);
  bends_.assign(map.cubes().size(), 0);
  const std::vector<Vec3> areas = node_areas(cage, u);
  for (std::size_t c = 0; c < map.cubes().size(); ++c) move(cage, c, u, areas);
}

void LayerMotion::move(const Cage& cage, std::size_t c, std::span<const Vec3> u,
                       std::span<const Vec3> areas) {
  const LayerMap::Cube& cube = map_->cubes()[c];
  const CageCell& cell = cage.cells()[cube.cell];
  const auto& n = cell.nodes;
  const bool still = std::all_of(n.begin(), n.end(), [&](std::uint32_t node) {
    return (u[node] - u[n[0]]).squaredNorm() < kStill * kStill;
  });
  if (still) return;
  moved_[c] = 1;
  const double edge = cage.edge(cell);
  for (int j = 0; j <= cube.across; ++j) {
    for (int i = 0; i <= cube.across; ++i) {
      const auto column = static_cast<std::size_t>(i + (cube.across + 1) * j);
      if (map_->even(cube.column + column)) continue;
      const double x = static_cast<double>(i) / cube.across;
      const double y = static_cast<double>(j) / cube.across;
      const Vec3 low = bilinear(areas[n[0]], areas[n[1]], areas[n[2]], areas[n[3]], x, y);
      const Vec3 high = bilinear(areas[n[4]], areas[n[5]], areas[n[6]], areas[n[7]], x, y);
      const Vec3 way = bilinear(u[n[4]] - u[n[0]], u[n[5]] - u[n[1]], u[n[6]] - u[n[2]],
                                u[n[7]] - u[n[3]], x, y);
      Ends ends;
      ends.area_low = low.norm();
      ends.area_high = high.norm();
      ends.length = (Vec3::UnitZ() + way / edge).dot((low + high).normalized());
      ends.contrast = map_->contrast(cube.column + column);
      if (!(std::min({ends.area_low, ends.area_high, ends.length}) > kLeastColumn)) continue;
      share(cube.first + column * cube.along, cube.along, ends,
            &shifts_[first_[c] + column * (cube.along + 1U)]);
    }
  }
  find_bends(c, edge);
}

/// The stretch of each layer: by its own volume, and of what is left its share by compliance, but
/// none thinner than it can be.
void LayerMotion::share(std::size_t first, std::size_t n, const Ends& ends,
                        float* shifts) const noexcept {
  std::array<Layer, kMostSamples> all{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (count == 0 || all[count - 1].kind != &map_->kind(first + k))
      all[count++] = {&map_->kind(first + k), k, k};
    all[count - 1].end = k + 1;
  }
  const std::span layers(all.data(), count);
  const double mean = 0.5 * (ends.area_low + ends.area_high);
  for (Layer& layer : layers) {
    const LayerMap::Kind& kind = *layer.kind;
    const double middle = 0.5 * static_cast<double>(layer.begin + layer.end);
    const double area =
        ends.area_low + middle / static_cast<double>(n) * (ends.area_high - ends.area_low);
    layer.stretch = kind.tissue ? 1 : ends.length;
    if (kind.compliance <= 0) continue;
    layer.stretch = 1 / (mean + ends.contrast * (area - mean));
    layer.give = layer.stretch * kind.compliance;
    layer.least = kind.shear > 0 ? kLeastSolid * std::min(1.0, layer.stretch) : kLeastFluid;
  }
  balance(layers, static_cast<double>(n) * ends.length);
  double sum = 0;
  for (const Layer& layer : layers) sum += layer.samples() * layer.stretch;
  double shift = 0;
  for (const Layer& layer : layers) {
    const double step = layer.stretch / sum - 1 / static_cast<double>(n);
    for (std::size_t k = layer.begin; k < layer.end && k + 1 < n; ++k) {
      shift += step;
      shifts[k + 1] = static_cast<float>(shift);
    }
  }
}

/// Levels between which each column's shifts are straight: the largest and the least slope since
/// the last one say how far a straight line can be off.
void LayerMotion::find_bends(std::size_t c, double edge) {
  const LayerMap::Cube& cube = map_->cubes()[c];
  const auto columns = static_cast<std::size_t>((cube.across + 1) * (cube.across + 1));
  const std::size_t n = cube.along;
  const float* shifts = &shifts_[first_[c]];
  std::array<float, 81> least{};
  std::array<float, 81> most{};
  std::size_t last = 0;
  for (std::size_t k = 0; k < n; ++k) {
    bool bent = false;
    for (std::size_t a = 0; a < columns; ++a) {
      const float step = shifts[a * (n + 1) + k + 1] - shifts[a * (n + 1) + k];
      least[a] = k == last ? step : std::min(least[a], step);
      most[a] = k == last ? step : std::max(most[a], step);
      bent = bent || 0.25 * static_cast<double>(most[a] - least[a]) *
                             static_cast<double>(k + 1 - last) * edge >
                         kStraight;
    }
    if (!bent) continue;
    bends_[c] |= std::uint64_t{1} << k;
    last = k;
    for (std::size_t a = 0; a < columns; ++a)
      least[a] = most[a] = shifts[a * (n + 1) + k + 1] - shifts[a * (n + 1) + k];
  }
}

LayerMotion::Shift LayerMotion::at(std::int32_t cell, const Vec3& s) const noexcept {
  const auto c = static_cast<std::size_t>(map_->cube_of(cell));
  const LayerMap::Cube& cube = map_->cubes()[c];
  const std::size_t stride = cube.along + 1U;
  const Vec3 places(s.x() * cube.across, s.y() * cube.across, s.z() * cube.along);
  std::array<std::size_t, 3> low{};
  Vec3 f;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const std::size_t most = k < 2 ? cube.across - 1U : cube.along - 1U;
    const auto at = static_cast<std::size_t>(k);
    low[at] = std::min(static_cast<std::size_t>(std::max(0.0, places[k])), most);
    f[k] = places[k] - static_cast<double>(low[at]);
  }
  const float* a = &shifts_[first_[c] + (low[0] + (cube.across + 1U) * low[1]) * stride + low[2]];
  const float* b = a + stride;
  const float* d = a + (cube.across + 1U) * stride;
  const float* e = d + stride;
  const auto value = [&](const float* p) {
    return p[0] + f.z() * (p[1] - p[0]);
  };
  const auto slope = [](const float* p) {
    return static_cast<double>(p[1] - p[0]);
  };
  const double near = value(a) + f.x() * (value(b) - value(a));
  const double far = value(d) + f.x() * (value(e) - value(d));
  Shift shift;
  shift.along = near + f.y() * (far - near);
  shift.slope.x() =
      cube.across * ((1 - f.y()) * (value(b) - value(a)) + f.y() * (value(e) - value(d)));
  shift.slope.y() = cube.across * (far - near);
  shift.slope.z() = cube.along * ((1 - f.y()) * ((1 - f.x()) * slope(a) + f.x() * slope(b)) +
                                  f.y() * ((1 - f.x()) * slope(d) + f.x() * slope(e)));
  return shift;
}

double LayerMotion::next_bend(std::int32_t cell, double s_z, bool up) const noexcept {
  constexpr double kOn = 1e-6;  // of a sample: on a level already
  const auto c = static_cast<std::size_t>(map_->cube_of(cell));
  const double n = map_->cubes()[c].along;
  const std::uint64_t bends = bends_[c];
  const double level = std::clamp(s_z, 0.0, 1.0) * n;
  if (up) {
    const auto from = static_cast<unsigned>(std::floor(level + kOn)) + 1;
    const std::uint64_t left = from < 64 ? bends >> from : 0;
    return left != 0 ? (from + static_cast<unsigned>(std::countr_zero(left))) / n : 1;
  }
  const auto below = static_cast<unsigned>(std::max(0.0, std::ceil(level - kOn)));  // exclusive
  const std::uint64_t left = below >= 64 ? bends : bends & ((std::uint64_t{1} << below) - 1);
  return left != 0 ? (63 - static_cast<unsigned>(std::countl_zero(left))) / n : 0;
}

}  // namespace artus
