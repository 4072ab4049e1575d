// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/label_pieces.h"

#include <algorithm>
#include <cstddef>

namespace artus {
namespace {

constexpr double kTouch = 3e-3;    // m, that two regions are neighbours from
constexpr double kApart = 0.3e-3;  // m, that they were none below

std::size_t at(const LabelImage& labels, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(labels.width) +
         static_cast<std::size_t>(x);
}

bool inside(const LabelWindow& window, int x, int y) {
  return x >= window.left && x < window.right && y >= window.top && y < window.bottom;
}

/// Walks one piece from a pixel on; returns how many of its pixels lie in the window. `seen`: by
/// pixel, the last region whose walk came there.
std::size_t walk(const LabelImage& labels, const LabelWindow& window, std::size_t from,
                 std::vector<RegionId>& seen) {
  const auto width = static_cast<std::size_t>(labels.width);
  const RegionId region = labels.regions[from];
  std::vector<std::size_t> open{from};
  seen[from] = region;
  std::size_t counted = 0;
  while (!open.empty()) {
    const std::size_t pixel = open.back();
    open.pop_back();
    const auto x = static_cast<int>(pixel % width);
    const auto y = static_cast<int>(pixel / width);
    if (labels.regions[pixel] == region && inside(window, x, y)) ++counted;
    const auto visit = [&](int nx, int ny) {
      if (nx < 0 || ny < 0 || nx >= labels.width || ny >= labels.height) return;
      const std::size_t next = at(labels, nx, ny);
      const RegionId there = labels.regions[next];
      if (seen[next] == region || (there != region && there != kPartedRegion)) return;
      seen[next] = region;
      open.push_back(next);
    };
    visit(x - 1, y);
    visit(x + 1, y);
    visit(x, y - 1);
    visit(x, y + 1);
  }
  return counted;
}

std::string name_of(RegionId region, const CompiledJoint& names) {
  return region >= kPartedRegion ? "liquid" : names.regions[region].name;
}

void add(std::string& list, const std::string& one) {
  list += (list.empty() ? "" : ", ") + one;
}

/// Whether the second, liquid, may come to touch the first.
bool may_touch(const std::pair<RegionId, RegionId>& pair, const CompiledJoint& names,
               const std::vector<bool>& parted) {
  const auto [tissue, liquid] = pair;
  if (liquid < kPartedRegion) return false;
  if (tissue == kBeyond || tissue >= kPartedRegion) return true;
  if (tissue < parted.size() && parted[tissue]) return true;
  if (liquid == kLiquidRegion || tissue < kFirstRegion) return false;
  const Tissue& known = names.tissue_of(tissue);
  return !known.haptic.hard && known.acoustic.kind != TissueKind::skin;
}

}  // namespace

void join_liquid(LabelImage& labels, const std::vector<bool>& liquid,
                 const std::vector<bool>& is_parted) {
  for (RegionId& region : labels.regions)
    if (region < liquid.size() && liquid[region])
      region = is_parted[region] ? kPartedRegion : kLiquidRegion;
}

void RegionLayout::add(const RegionLayout& other) {
  for (const auto& [region, n] : other.pieces) pieces[region] = std::max(pieces[region], n);
  add_contacts(other);
}

void RegionLayout::add_contacts(const RegionLayout& other) {
  for (const auto& [pair, length] : other.contacts)
    contacts[pair] = std::max(contacts[pair], length);
}

RegionLayout find_layout(const LabelImage& labels, const LabelWindow& window, double min_area) {
  RegionLayout layout;
  constexpr RegionId kNone = 0xfffd;
  std::vector<RegionId> seen(labels.regions.size(), kNone);
  const double pixel_area = labels.pixel * labels.pixel;
  for (std::size_t i = 0; i < labels.regions.size(); ++i) {
    if (seen[i] == labels.regions[i]) continue;
    const std::size_t pixels = walk(labels, window, i, seen);
    if (pixels > 0 && static_cast<double>(pixels) * pixel_area >= min_area)
      ++layout.pieces[labels.regions[i]];
  }
  const auto touch = [&](RegionId a, RegionId b) {
    if (a != b) layout.contacts[{std::min(a, b), std::max(a, b)}] += labels.pixel;
  };
  for (int y = window.top; y < window.bottom; ++y)
    for (int x = window.left; x < window.right; ++x) {
      const RegionId here = labels.regions[at(labels, x, y)];
      if (x + 1 < window.right) touch(here, labels.regions[at(labels, x + 1, y)]);
      if (y + 1 < window.bottom) touch(here, labels.regions[at(labels, x, y + 1)]);
    }
  return layout;
}

LayoutChange compare_layouts(const RegionLayout& before, const RegionLayout& after,
                             const CompiledJoint& names, const std::vector<bool>& parted) {
  LayoutChange change;
  for (const auto& [region, n] : after.pieces) {
    if (region < kFirstRegion || region >= kPartedRegion) continue;
    const auto was = before.pieces.find(region);
    const int more = n - (was == before.pieces.end() ? 0 : was->second);
    if (more <= 0) continue;
    change.fragments += more;
    add(change.which_fragments,
        name_of(region, names) + ' ' + std::to_string(n - more) + " -> " + std::to_string(n));
  }
  for (const auto& [pair, length] : after.contacts) {
    if (length < kTouch || may_touch(pair, names, parted)) continue;
    const auto was = before.contacts.find(pair);
    if (was != before.contacts.end() && was->second >= kApart) continue;
    ++change.neighbours;
    add(change.which_neighbours, name_of(pair.first, names) + " at " + name_of(pair.second, names));
  }
  return change;
}

}  // namespace artus
