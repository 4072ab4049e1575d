// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/tet_locator.h"

#include <algorithm>
#include <cmath>

#include "artus/core/check.h"

namespace artus {

TetLocator::TetLocator(const TetMesh& mesh, double box) : mesh_(mesh), box_(box) {
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
    size_[k] = 1 + static_cast<int>((high[axis] - low_[axis]) / box_);
  }
  const std::size_t n = index(size_[0] - 1, size_[1] - 1, size_[2] - 1) + 1;
  start_.assign(n + 1, 0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    visit_boxes(t, [&](std::size_t b) { ++start_[b + 1]; });
  for (std::size_t b = 0; b < n; ++b) start_[b + 1] += start_[b];
  members_.resize(start_.back());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    visit_boxes(t, [&](std::size_t b) { members_[next[b]++] = static_cast<std::uint32_t>(t); });
}

std::array<int, 3> TetLocator::box_of(const Vec3& p) const noexcept {
  std::array<int, 3> at{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    at[k] = static_cast<int>(std::clamp(std::floor((p[axis] - low_[axis]) / box_), 0.0,
                                        static_cast<double>(size_[k] - 1)));
  }
  return at;
}

std::size_t TetLocator::index(int x, int y, int z) const noexcept {
  return static_cast<std::size_t>(x) +
         static_cast<std::size_t>(size_[0]) *
             (static_cast<std::size_t>(y) +
              static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(z));
}

template <class Visit>
void TetLocator::visit_boxes(std::size_t tet, Visit visit) const {
  const auto& [a, b, c, d] = mesh_.tetrahedra[tet];
  const auto& v = mesh_.vertices;
  const auto low = box_of(v[a].cwiseMin(v[b]).cwiseMin(v[c]).cwiseMin(v[d]));
  const auto high = box_of(v[a].cwiseMax(v[b]).cwiseMax(v[c]).cwiseMax(v[d]));
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x) visit(index(x, y, z));
    }
  }
}

std::int64_t TetLocator::find(const Vec3& p) const noexcept {
  const Vec3 last = box_ * Vec3(size_[0], size_[1], size_[2]);
  if (!((p - low_).minCoeff() >= 0) || !((low_ + last - p).minCoeff() >= 0)) return -1;
  const auto at = box_of(p);
  const std::size_t b = index(at[0], at[1], at[2]);
  for (std::uint32_t k = start_[b]; k < start_[b + 1]; ++k) {
    const auto& [i0, i1, i2, i3] = mesh_.tetrahedra[members_[k]];
    const auto& v = mesh_.vertices;
    const Vec3 a = v[i0] - p;
    const Vec3 e1 = v[i1] - v[i0];
    const Vec3 e2 = v[i2] - v[i0];
    const Vec3 e3 = v[i3] - v[i0];
    // One face after the other: most tetrahedra of a box are left at the first.
    const Vec3 e12 = e1.cross(e2);
    const double volume = e12.dot(e3);
    const double slack = -1e-9 * volume;
    const double w3 = -a.dot(e12);
    if (!(w3 >= slack)) continue;
    const double w1 = -a.dot(e2.cross(e3));
    if (!(w1 >= slack)) continue;
    const double w2 = -a.dot(e3.cross(e1));
    if (w2 >= slack && volume - w1 - w2 - w3 >= slack)
      return static_cast<std::int64_t>(members_[k]);
  }
  return -1;
}

}  // namespace artus
