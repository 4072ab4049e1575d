// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/clear_level.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "artus/detail/anatomy/body/liquid.h"

namespace artus {
namespace {

constexpr int kLevels = 64;

/// A triangle of a region's surface: heights of its corners, rising, and its outward area as seen
/// from above.
struct FacetHeights {
  std::array<double, 3> z{};  // m
  double area = 0;            // m^2
};

/// Integral over the facet, seen from above, of how far it lies above `level`, m^3.
double volume_above(const FacetHeights& facet, double level) {
  const double low = facet.z[0] - level;
  const double middle = facet.z[1] - level;
  const double high = facet.z[2] - level;
  if (high <= 0) return 0;
  const double mean = (low + middle + high) / 3;
  if (low >= 0) return facet.area * mean;
  if (middle <= 0) return facet.area * high * high * high / (3 * (high - low) * (high - middle));
  return facet.area * (mean - low * low * low / (3 * (middle - low) * (high - low)));
}

std::vector<FacetHeights> facets_of(const CompiledJoint& joint, RegionId region, const Vec3& up) {
  std::vector<FacetHeights> facets;
  for (const Interface& f : joint.mesh.interfaces) {
    if ((f.front == region) == (f.back == region)) continue;
    const auto at = [&](std::size_t k) -> const Vec3& {
      return joint.mesh.vertices[f.vertices[k]];
    };
    const double area = 0.5 * up.dot((at(1) - at(0)).cross(at(2) - at(0)));
    FacetHeights facet{{up.dot(at(0)), up.dot(at(1)), up.dot(at(2))},
                       f.back == region ? area : -area};
    std::sort(facet.z.begin(), facet.z.end());
    facets.push_back(facet);
  }
  return facets;
}

}  // namespace

ClearLevels::ClearLevels(const CompiledJoint& joint, const Vec3& up_J) {
  for (std::size_t r = kFirstRegion; r < joint.regions.size(); ++r) {
    const auto region = static_cast<RegionId>(r);
    const Tissue& tissue = joint.tissue_of(region);
    if (!is_injected(tissue.name) || !(tissue.acoustic.backscatter > 0)) continue;
    const std::vector<FacetHeights> facets = facets_of(joint, region, up_J);
    if (facets.empty()) continue;
    Table table;
    table.region = region;
    double bottom = std::numeric_limits<double>::infinity();
    table.top = -bottom;
    for (const FacetHeights& facet : facets) {
      table.roof += std::max(0.0, facet.area);
      table.top = std::max(table.top, facet.z[2]);
      bottom = std::min(bottom, facet.z[0]);
    }
    table.step = (table.top - bottom) / (kLevels - 1);
    for (int k = 0; k < kLevels; ++k) {
      double sum = 0;
      for (const FacetHeights& facet : facets)
        sum += volume_above(facet, table.top - k * table.step);
      table.above.push_back(std::max(sum, k == 0 ? 0 : table.above.back()));
    }
    tables_.push_back(std::move(table));
  }
}

double ClearLevels::height(RegionId region, double fallen) const noexcept {
  const auto table = std::find_if(tables_.begin(), tables_.end(),
                                  [&](const Table& t) { return t.region == region; });
  if (table == tables_.end() || !(fallen > 0)) return std::numeric_limits<double>::infinity();
  const std::vector<double>& above = table->above;
  const double cleared = fallen * table->roof;
  const auto next = std::upper_bound(above.begin(), above.end(), cleared);
  if (next == above.begin()) return table->top;
  if (next == above.end()) return table->top - (kLevels - 1) * table->step;
  const double before = *(next - 1);
  const double at =
      static_cast<double>(next - above.begin()) - 1 + (cleared - before) / (*next - before);
  return table->top - at * table->step;
}

}  // namespace artus
