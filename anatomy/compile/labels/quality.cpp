// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/quality.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "artus/detail/core/units.h"

namespace artus {

double TetQuality::above_8_deg_percent() const noexcept {
  const auto n = std::accumulate(histogram.begin(), histogram.end(), std::size_t{0});
  if (n == 0) return 100;
  return 100 * (1 - static_cast<double>(below_8_deg) / static_cast<double>(n));
}

std::pair<double, double> dihedral_range_deg(const std::array<Vec3, 4>& p) {
  // outward normals of the faces opposite each corner, for a positive tetrahedron
  const std::array<Vec3, 4> n{(p[2] - p[1]).cross(p[3] - p[1]).stableNormalized(),
                              (p[3] - p[0]).cross(p[2] - p[0]).stableNormalized(),
                              (p[1] - p[0]).cross(p[3] - p[0]).stableNormalized(),
                              (p[2] - p[0]).cross(p[1] - p[0]).stableNormalized()};
  double smallest = 180;
  double largest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      const double angle = std::acos(std::clamp(-n[i].dot(n[j]), -1.0, 1.0)) / kDegree;
      smallest = std::min(smallest, angle);
      largest = std::max(largest, angle);
    }
  }
  return {smallest, largest};
}

TetQuality compute_quality(const TetMesh& mesh) {
  constexpr double kLimit = 8;  // deg
  TetQuality quality;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& tet = mesh.tetrahedra[t];
    const auto [low, high] = dihedral_range_deg({mesh.vertices[tet[0]], mesh.vertices[tet[1]],
                                                 mesh.vertices[tet[2]], mesh.vertices[tet[3]]});
    const auto bin = static_cast<std::size_t>(low / TetQuality::kBin);
    ++quality.histogram[std::min(bin, quality.histogram.size() - 1)];
    quality.smallest_deg = std::min(quality.smallest_deg, low);
    quality.largest_deg = std::max(quality.largest_deg, high);
    if (low < kLimit) ++quality.below_8_deg;
    if (!(tet_volume(mesh, t) > 0)) ++quality.inverted;
  }
  return quality;
}

}  // namespace artus
