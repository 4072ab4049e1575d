// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/seen_structures.h"

#include <algorithm>
#include <cstddef>

#include "artus/detail/anatomy/body/find_region.h"

namespace artus {
namespace {

/// How deep below the skin a column first meets a region, m; negative: nowhere.
double depth_in_column(const LabelImage& labels, RegionId region, int x) {
  int skin = -1;
  for (int y = 0; y < labels.height; ++y) {
    const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(labels.width) +
                    static_cast<std::size_t>(x);
    if (labels.regions[at] == kOutside) continue;
    if (skin < 0) skin = y;
    if (labels.regions[at] == region) return (y - skin) * labels.pixel;
  }
  return -1;
}

/// How deep each column first meets a structure, m; negative: nowhere.
std::vector<double> depths_of(const LabelImage& labels, const CompiledJoint& joint,
                              const std::string& name) {
  std::vector<double> depths(static_cast<std::size_t>(labels.width), -1);
  const auto region = find_region(joint, name);
  if (!region) return depths;
  for (int x = 0; x < labels.width; ++x)
    depths[static_cast<std::size_t>(x)] = depth_in_column(labels, *region, x);
  return depths;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

SeenStructure summary_of(const std::string& name, const std::vector<double>& depths) {
  SeenStructure seen;
  seen.structure = name;
  std::vector<double> held;
  double columns = 0;
  for (std::size_t x = 0; x < depths.size(); ++x) {
    if (depths[x] < 0) continue;
    held.push_back(depths[x]);
    columns += static_cast<double>(x);
  }
  if (held.empty() || depths.size() < 2) return seen;
  const auto n = static_cast<double>(held.size());
  const auto width = static_cast<double>(depths.size());
  seen.share = n / width;
  seen.depth = median_of(std::move(held));
  seen.side = 2 * columns / n / (width - 1) - 1;
  return seen;
}

/// Whether, where a column holds both, the first mostly begins nearer to the skin.
bool lies_before(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<double> below;
  for (std::size_t x = 0; x < first.size(); ++x)
    if (first[x] >= 0 && second[x] >= 0) below.push_back(second[x] - first[x]);
  return below.empty() || median_of(std::move(below)) >= 0;
}

SightFault fault_of(const SeenStructure& seen, const ViewSight& sight, bool in_order) {
  if (seen.share < kSeenShare) return SightFault::not_seen;
  if (seen.depth < sight.least || seen.depth > sight.most) return SightFault::depth;
  if (!in_order) return SightFault::order;
  if (sight.side == ViewSide::left && seen.side >= 0) return SightFault::side;
  if (sight.side == ViewSide::right && seen.side <= 0) return SightFault::side;
  return SightFault::none;
}

}  // namespace

std::vector<SeenStructure> find_seen(const LabelImage& labels, const CompiledJoint& joint,
                                     const StandardView& view) {
  std::vector<SeenStructure> all;
  std::vector<double> before;  // of the one before, in order
  for (const ViewSight& sight : view.sights) {
    const std::vector<double> depths = depths_of(labels, joint, sight.structure);
    SeenStructure seen = summary_of(sight.structure, depths);
    const bool is_ordered = sight.side == ViewSide::anywhere;
    seen.fault =
        fault_of(seen, sight, !is_ordered || before.empty() || lies_before(before, depths));
    if (is_ordered && seen.fault != SightFault::not_seen) before = depths;
    all.push_back(std::move(seen));
  }
  return all;
}

}  // namespace artus
