// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/resolve_seeds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include <tbb/parallel_for.h>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

using Label = std::function<RegionId(const Vec3&)>;

constexpr double kBisectionEnd = 1e-3;  // of the grid's spacing

struct Grid {
  Vec3 origin;
  double spacing;
  std::array<std::size_t, 3> n;

  Grid(const Box& box, double h) : origin(box.lower), spacing(h), n{} {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<Eigen::Index>(a);
      n[a] = static_cast<std::size_t>(std::max(0.0, (box.upper[i] - box.lower[i]) / h)) + 2;
    }
  }
  [[nodiscard]] std::size_t index(std::size_t x, std::size_t y, std::size_t z) const {
    return x + n[0] * (y + n[1] * z);
  }
  [[nodiscard]] Vec3 point(std::size_t x, std::size_t y, std::size_t z) const {
    return origin +
           spacing * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
  }
};

BoundarySeed bisect(const Label& label, Vec3 p, Vec3 q, RegionId at_p, RegionId at_q) {
  const double end = kBisectionEnd * (q - p).norm();
  while ((q - p).norm() > end) {
    const Vec3 middle = (p + q) / 2;
    const RegionId here = label(middle);
    if (here == at_p) {
      p = middle;
    } else {
      q = middle;
      at_q = here;
    }
  }
  return {(p + q) / 2, at_p, at_q};
}

void seeds_of_point(const Label& label, const Grid& grid, const std::vector<RegionId>& labels,
                    const std::array<std::size_t, 3>& i, std::vector<BoundarySeed>& out) {
  const RegionId here = labels[grid.index(i[0], i[1], i[2])];
  for (std::size_t a = 0; a < 3; ++a) {
    std::array<std::size_t, 3> next = i;
    if (++next[a] == grid.n[a]) continue;
    const RegionId there = labels[grid.index(next[0], next[1], next[2])];
    if (here == there) continue;
    out.push_back(bisect(label, grid.point(i[0], i[1], i[2]), grid.point(next[0], next[1], next[2]),
                         here, there));
  }
}

}  // namespace

std::vector<BoundarySeed> find_boundary_seeds(const Label& label, const Box& box, double spacing) {
  const Grid grid(box, spacing);
  std::vector<RegionId> labels(grid.n[0] * grid.n[1] * grid.n[2]);
  tbb::parallel_for(std::size_t{0}, grid.n[2], [&](std::size_t z) {
    for (std::size_t y = 0; y < grid.n[1]; ++y) {
      for (std::size_t x = 0; x < grid.n[0]; ++x) {
        labels[grid.index(x, y, z)] = label(grid.point(x, y, z));
      }
    }
  });
  std::vector<std::vector<BoundarySeed>> planes(grid.n[2]);
  tbb::parallel_for(std::size_t{0}, grid.n[2], [&](std::size_t z) {
    for (std::size_t y = 0; y < grid.n[1]; ++y) {
      for (std::size_t x = 0; x < grid.n[0]; ++x) {
        seeds_of_point(label, grid, labels, {x, y, z}, planes[z]);
      }
    }
  });
  std::vector<BoundarySeed> seeds;
  for (const auto& plane : planes) seeds.insert(seeds.end(), plane.begin(), plane.end());
  return seeds;
}

std::vector<BoundarySeed> thin_seeds(const std::vector<BoundarySeed>& seeds,
                                     const std::function<double(const BoundarySeed&)>& distance,
                                     double largest) {
  using Cell = std::array<std::int64_t, 3>;
  const auto cell_of = [largest](const Vec3& p) {
    return Cell{static_cast<std::int64_t>(std::floor(p[0] / largest)),
                static_cast<std::int64_t>(std::floor(p[1] / largest)),
                static_cast<std::int64_t>(std::floor(p[2] / largest))};
  };
  const auto key_of = [](const Cell& c) {
    return static_cast<std::uint64_t>((c[0] * 2097152 + c[1]) * 2097152 + c[2]);
  };
  std::unordered_map<std::uint64_t, std::vector<Vec3>> kept_in;
  const auto is_free = [&](const Vec3& p, double r) {
    const Cell c = cell_of(p);
    for (int i = 0; i < 27; ++i) {
      const Cell near{c[0] + i % 3 - 1, c[1] + i / 3 % 3 - 1, c[2] + i / 9 - 1};
      const auto found = kept_in.find(key_of(near));
      if (found == kept_in.end()) continue;
      const auto& points = found->second;
      if (std::any_of(points.begin(), points.end(),
                      [&](const Vec3& k) { return (k - p).squaredNorm() < r * r; })) {
        return false;
      }
    }
    return true;
  };
  std::vector<std::size_t> order(seeds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [](std::size_t a, std::size_t b) { return mix_bits(a) < mix_bits(b); });
  std::vector<BoundarySeed> kept;
  for (const std::size_t i : order) {
    const BoundarySeed& seed = seeds[i];
    if (!is_free(seed.point, std::min(distance(seed), largest))) continue;
    kept_in[key_of(cell_of(seed.point))].push_back(seed.point);
    kept.push_back(seed);
  }
  return kept;
}

}  // namespace artus
