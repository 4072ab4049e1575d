// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/bevel.h"

#include <algorithm>

namespace artus {
namespace {

std::uint32_t space_of(RegionId region, std::span<const std::uint32_t> of_region) noexcept {
  return region < of_region.size() ? of_region[region] : of_region[kOutside];
}

}  // namespace

std::array<TipShare, 2> bevel_shares(const NeedleContact& contact, double bevel,
                                     std::span<const std::uint32_t> of_region) noexcept {
  std::array<TipShare, 2> shares{{{space_of(kOutside, of_region), 1}, {}}};
  if (!contact.inserted()) return shares;
  const NeedleTick& tick = contact.tick();
  shares[0].space = space_of(contact.region(), of_region);
  for (const ShaftLayer& s : tick.shaft) {
    const double from = std::max(s.entry, tick.depth - bevel);
    const double to = std::min(s.exit, tick.depth);
    const std::uint32_t space = space_of(s.region, of_region);
    if (!(to > from) || space == shares[0].space) continue;
    const double share = std::min((to - from) / bevel, 1 - shares[1].share);
    if (share < shares[1].share) continue;
    shares[1] = {space, share};
  }
  if (tick.depth < bevel) shares[1] = {space_of(kOutside, of_region), 1 - tick.depth / bevel};
  shares[1].share = std::clamp(shares[1].share, 0.0, 1.0);
  shares[0].share = 1 - shares[1].share;
  return shares;
}

}  // namespace artus
