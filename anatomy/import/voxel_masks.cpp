// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/voxel_masks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

namespace artus {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// Lower envelope of parabolas over one line of squared distances.
class LineTransform {
 public:
  explicit LineTransform(std::size_t n) : value_(n), at_(n), from_(n + 1) {}

  void run(float* data, std::size_t n, std::size_t stride, double spacing) {
    std::size_t k = 0;
    bool any = false;
    for (std::size_t q = 0; q < n; ++q) {
      value_[q] = data[q * stride];
      if (!std::isfinite(value_[q])) continue;
      const double x = static_cast<double>(q) * spacing;
      double s = -std::numeric_limits<double>::infinity();
      while (any) {
        const double y = static_cast<double>(at_[k]) * spacing;
        s = (value_[q] + x * x - value_[at_[k]] - y * y) / (2 * (x - y));
        if (s > from_[k]) break;
        if (k == 0) {
          any = false;
          s = -std::numeric_limits<double>::infinity();
          break;
        }
        --k;
      }
      if (any) ++k;
      any = true;
      at_[k] = q;
      from_[k] = s;
    }
    if (!any) return;
    const std::size_t last = k;
    k = 0;
    for (std::size_t q = 0; q < n; ++q) {
      const double x = static_cast<double>(q) * spacing;
      while (k < last && from_[k + 1] < x) ++k;
      const double d = x - static_cast<double>(at_[k]) * spacing;
      data[q * stride] = static_cast<float>(d * d + value_[at_[k]]);
    }
  }

 private:
  std::vector<double> value_;
  std::vector<std::size_t> at_;
  std::vector<double> from_;
};

/// What can be reached by faces from `start` through voxels of `through` is given `mark`.
std::size_t flood(const VoxelMask& mask, std::vector<std::uint32_t>& marks, std::size_t start,
                  std::uint32_t mark) {
  const auto& s = mask.size;
  std::vector<std::size_t> open{start};
  marks[start] = mark;
  std::size_t n = 0;
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    ++n;
    const std::array<std::size_t, 3> p{i % s[0], i / s[0] % s[1], i / (s[0] * s[1])};
    std::size_t step = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const bool up : {false, true}) {
        if (up ? p[axis] + 1 >= s[axis] : p[axis] == 0) continue;
        const std::size_t k = up ? i + step : i - step;
        if (mask.is_in[k] == 0 || marks[k] != 0) continue;
        marks[k] = mark;
        open.push_back(k);
      }
      step *= s[axis];
    }
  }
  return n;
}

/// In one plane of the grid: what no path of empty voxels joins to its rim.
class PlaneFiller {
 public:
  PlaneFiller(std::size_t n, std::size_t m) : n_(n), m_(m), seen_(n * m) {}

  /// `at` gives the index of voxel (i, k) of the plane.
  template <class At>
  void run(const VoxelMask& mask, std::vector<std::uint8_t>& filled, At at) {
    std::fill(seen_.begin(), seen_.end(), std::uint8_t{0});
    open_.clear();
    const auto visit = [&](std::size_t i, std::size_t k) {
      std::uint8_t& seen = seen_[k * n_ + i];
      if (seen != 0 || mask.is_in[at(i, k)] != 0) return;
      seen = 1;
      open_.emplace_back(i, k);
    };
    for (std::size_t i = 0; i < n_; ++i) {
      visit(i, 0);
      visit(i, m_ - 1);
    }
    for (std::size_t k = 0; k < m_; ++k) {
      visit(0, k);
      visit(n_ - 1, k);
    }
    while (!open_.empty()) {
      const auto [i, k] = open_.back();
      open_.pop_back();
      if (i > 0) visit(i - 1, k);
      if (i + 1 < n_) visit(i + 1, k);
      if (k > 0) visit(i, k - 1);
      if (k + 1 < m_) visit(i, k + 1);
    }
    for (std::size_t k = 0; k < m_; ++k)
      for (std::size_t i = 0; i < n_; ++i)
        if (seen_[k * n_ + i] == 0) filled[at(i, k)] = 1;
  }

 private:
  std::size_t n_, m_;
  std::vector<std::uint8_t> seen_;
  std::vector<std::pair<std::size_t, std::size_t>> open_;
};

/// A mask of cells of several voxels, with room around it.
struct CoarseGrid {
  VoxelMask mask;
  std::array<std::size_t, 3> factor{1, 1, 1};
  std::size_t rim = 0;  // cells
  Vec3 spacing;
};

CoarseGrid coarsen(const VoxelMask& fine, const Vec3& spacing, double room, double cell) {
  CoarseGrid coarse;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto k = static_cast<Eigen::Index>(a);
    coarse.factor[a] = static_cast<std::size_t>(std::max(1.0, std::round(cell / spacing[k])));
    coarse.spacing[k] = static_cast<double>(coarse.factor[a]) * spacing[k];
  }
  coarse.rim = static_cast<std::size_t>(std::ceil(room / coarse.spacing.minCoeff())) + 1;
  auto& size = coarse.mask.size;
  for (std::size_t a = 0; a < 3; ++a)
    size[a] = (fine.size[a] + coarse.factor[a] - 1) / coarse.factor[a] + 2 * coarse.rim;
  coarse.mask.is_in.assign(size[0] * size[1] * size[2], 0);
  std::size_t i = 0;
  for (std::size_t z = 0; z < fine.size[2]; ++z)
    for (std::size_t y = 0; y < fine.size[1]; ++y) {
      const std::size_t row =
          ((z / coarse.factor[2] + coarse.rim) * size[1] + y / coarse.factor[1] + coarse.rim) *
              size[0] +
          coarse.rim;
      for (std::size_t x = 0; x < fine.size[0]; ++x, ++i)
        if (fine.is_in[i] != 0) coarse.mask.is_in[row + x / coarse.factor[0]] = 1;
    }
  return coarse;
}

}  // namespace

std::vector<float> distances_to(const VoxelMask& mask, bool what, const Vec3& spacing) {
  std::vector<float> squared(mask.is_in.size());
  for (std::size_t i = 0; i < squared.size(); ++i)
    squared[i] = (mask.is_in[i] != 0) == what ? 0.0F : kInfinite;
  const auto& s = mask.size;
  tbb::parallel_for(std::size_t{0}, s[2], [&](std::size_t z) {
    LineTransform line(std::max(s[0], s[1]));
    float* plane = squared.data() + z * s[0] * s[1];
    for (std::size_t y = 0; y < s[1]; ++y) line.run(plane + y * s[0], s[0], 1, spacing.x());
    for (std::size_t x = 0; x < s[0]; ++x) line.run(plane + x, s[1], s[0], spacing.y());
  });
  tbb::parallel_for(std::size_t{0}, s[1], [&](std::size_t y) {
    LineTransform line(s[2]);
    for (std::size_t x = 0; x < s[0]; ++x)
      line.run(squared.data() + y * s[0] + x, s[2], s[0] * s[1], spacing.z());
  });
  for (float& d : squared) d = std::sqrt(d);
  return squared;
}

void keep_largest(VoxelMask& mask) {
  std::vector<std::uint32_t> marks(mask.is_in.size(), 0);
  std::uint32_t n_parts = 0;
  std::uint32_t best = 0;
  std::size_t most = 0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (mask.is_in[i] == 0 || marks[i] != 0) continue;
    const std::size_t n = flood(mask, marks, i, ++n_parts);
    if (n > most) {
      most = n;
      best = n_parts;
    }
  }
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i] != best) mask.is_in[i] = 0;
}

void fill_enclosed(VoxelMask& mask) {
  std::vector<std::uint8_t> filled(mask.is_in.size(), 0);
  const auto& s = mask.size;
  const std::array<std::size_t, 3> step{1, s[0], s[0] * s[1]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t a = (axis + 1) % 3;
    const std::size_t b = (axis + 2) % 3;
    if (s[axis] < 2) continue;  // a single slice encloses nothing of its own
    tbb::parallel_for(std::size_t{0}, s[axis], [&](std::size_t p) {
      PlaneFiller filler(s[a], s[b]);
      std::vector<std::uint8_t>& to = filled;
      filler.run(mask, to, [&](std::size_t i, std::size_t k) {
        return p * step[axis] + i * step[a] + k * step[b];
      });
    });
  }
  for (std::size_t i = 0; i < filled.size(); ++i)
    if (filled[i] != 0) mask.is_in[i] = 1;
}

VoxelMask closed_hull(const VoxelMask& mask, const Vec3& spacing, double out, double in,
                      double cell) {
  const CoarseGrid coarse = coarsen(mask, spacing, out + cell, cell);
  VoxelMask grown = coarse.mask;
  const auto away = distances_to(coarse.mask, true, coarse.spacing);
  for (std::size_t i = 0; i < away.size(); ++i)
    grown.is_in[i] = static_cast<double>(away[i]) <= out ? 1 : 0;
  const auto deep = distances_to(grown, false, coarse.spacing);
  VoxelMask hull;
  hull.size = mask.size;
  hull.is_in.assign(mask.is_in.size(), 0);
  const auto& size = coarse.mask.size;
  tbb::parallel_for(std::size_t{0}, mask.size[2], [&](std::size_t z) {
    std::size_t i = z * mask.size[0] * mask.size[1];
    // Position of a voxel's centre among the centres of the cells.
    const auto place = [&](std::size_t v, std::size_t axis) {
      return (static_cast<double>(v) + 0.5) / static_cast<double>(coarse.factor.at(axis)) - 0.5 +
             static_cast<double>(coarse.rim);
    };
    const double w = place(z, 2);
    for (std::size_t y = 0; y < mask.size[1]; ++y) {
      const double v = place(y, 1);
      for (std::size_t x = 0; x < mask.size[0]; ++x, ++i) {
        const double u = place(x, 0);
        double d = 0;
        for (int c = 0; c < 8; ++c) {
          const std::size_t cx = static_cast<std::size_t>(u) + (c & 1);
          const std::size_t cy = static_cast<std::size_t>(v) + (c >> 1 & 1);
          const std::size_t cz = static_cast<std::size_t>(w) + (c >> 2 & 1);
          const double share = (1 - std::abs(u - static_cast<double>(cx))) *
                               (1 - std::abs(v - static_cast<double>(cy))) *
                               (1 - std::abs(w - static_cast<double>(cz)));
          d += share * static_cast<double>(deep[(cz * size[1] + cy) * size[0] + cx]);
        }
        hull.is_in[i] = d > in || mask.is_in[i] != 0 ? 1 : 0;
      }
    }
  });
  return hull;
}

}  // namespace artus
