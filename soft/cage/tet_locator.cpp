// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/tet_locator.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

/// m by which an extent is widened, so that a point on a face is never left by rounding.
constexpr double kMargin = 1e-9;

/// Least and greatest coordinates, m.
std::array<Vec3, 2> extent_of(const TetMesh& mesh, std::size_t tet) noexcept {
  const auto& [a, b, c, d] = mesh.tetrahedra[tet];
  const auto& v = mesh.vertices;
  return {v[a].cwiseMin(v[b]).cwiseMin(v[c]).cwiseMin(v[d]),
          v[a].cwiseMax(v[b]).cwiseMax(v[c]).cwiseMax(v[d])};
}

}  // namespace

TetLocator::TetLocator(const TetMesh& mesh, double box) : mesh_(mesh), per_metre_(1 / box) {
  ARTUS_REQUIRE(!mesh.tetrahedra.empty() && box > 0, "a mesh with tetrahedra");
  Vec3 high = mesh.vertices[mesh.tetrahedra[0][0]];
  low_ = high;
  for (const auto& tet : mesh.tetrahedra) {
    for (const std::uint32_t v : tet) {
      low_ = low_.cwiseMin(mesh.vertices[v]);
      high = high.cwiseMax(mesh.vertices[v]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    size_[k] = 1 + static_cast<int>((high[axis] - low_[axis]) * per_metre_);
  }
  const std::size_t n = index({size_[0] - 1, size_[1] - 1, size_[2] - 1}) + 1;
  start_.assign(n + 1, 0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    visit_boxes(extent_of(mesh, t), [&](const std::array<int, 3>& at) { ++start_[index(at) + 1]; });
  for (std::size_t b = 0; b < n; ++b) start_[b + 1] += start_[b];
  members_.resize(start_.back());
  extents_.resize(start_.back());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const std::array<Vec3, 2> extent = extent_of(mesh, t);
    const Vec3 from = extent[0] - Vec3::Constant(kMargin);
    const Vec3 to = extent[1] + Vec3::Constant(kMargin);
    visit_boxes(extent, [&](const std::array<int, 3>& at) {
      const std::uint32_t k = next[index(at)]++;
      members_[k] = static_cast<std::uint32_t>(t);
      extents_[k] = {steps_in(at, from), steps_in(at, to)};
    });
  }
}

std::array<int, 3> TetLocator::box_of(const Vec3& p) const noexcept {
  std::array<int, 3> at{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const double boxes = (p[axis] - low_[axis]) * per_metre_;
    at[k] = static_cast<int>(std::clamp(boxes, 0.0, static_cast<double>(size_[k] - 1)));
  }
  return at;
}

/// Where in a box `p` lies, in 255ths of its side; beyond its ends the nearest of them.
std::array<std::uint8_t, 3> TetLocator::steps_in(const std::array<int, 3>& box,
                                                 const Vec3& p) const noexcept {
  std::array<std::uint8_t, 3> steps{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const double at = (p[axis] - low_[axis]) * per_metre_ - box[k];
    steps[k] = static_cast<std::uint8_t>(std::clamp(255 * at, 0.0, 255.0));
  }
  return steps;
}

std::size_t TetLocator::index(const std::array<int, 3>& box) const noexcept {
  return static_cast<std::size_t>(box[0]) +
         static_cast<std::size_t>(size_[0]) *
             (static_cast<std::size_t>(box[1]) +
              static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(box[2]));
}

template <class Visit>
void TetLocator::visit_boxes(const std::array<Vec3, 2>& extent, Visit visit) const {
  const auto low = box_of(extent[0]);
  const auto high = box_of(extent[1]);
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x) visit({x, y, z});
    }
  }
}

/// One face after the other: most are left at the first.
bool TetLocator::holds(std::uint32_t tet, const Vec3& p) const noexcept {
  const auto& [i0, i1, i2, i3] = mesh_.tetrahedra[tet];
  const auto& v = mesh_.vertices;
  const Vec3 a = v[i0] - p;
  const Vec3 e1 = v[i1] - v[i0];
  const Vec3 e2 = v[i2] - v[i0];
  const Vec3 e3 = v[i3] - v[i0];
  const Vec3 e12 = e1.cross(e2);
  const double volume = e12.dot(e3);
  const double slack = -1e-9 * volume;
  const double w3 = -a.dot(e12);
  if (!(w3 >= slack)) return false;
  const double w1 = -a.dot(e2.cross(e3));
  if (!(w1 >= slack)) return false;
  const double w2 = -a.dot(e3.cross(e1));
  return w2 >= slack && volume - w1 - w2 - w3 >= slack;
}

std::int64_t TetLocator::find(const Vec3& p) const noexcept {
  const Vec3 boxes = (p - low_) * per_metre_;
  const Vec3 last(size_[0], size_[1], size_[2]);
  if (!(boxes.array() >= 0).all() || !(boxes.array() <= last.array()).all()) return -1;
  const auto at = box_of(p);
  const std::size_t b = index(at);
  const auto step = steps_in(at, p);
  const auto within = [&step](const Extent& e) {
    return static_cast<int>(e.low[0] <= step[0]) & static_cast<int>(step[0] <= e.high[0]) &
           static_cast<int>(e.low[1] <= step[1]) & static_cast<int>(step[1] <= e.high[1]) &
           static_cast<int>(e.low[2] <= step[2]) & static_cast<int>(step[2] <= e.high[2]);
  };
  for (std::uint32_t k = start_[b]; k < start_[b + 1]; ++k) {
    if (within(extents_[k]) != 0 && holds(members_[k], p))
      return static_cast<std::int64_t>(members_[k]);
  }
  return -1;
}

}  // namespace artus
