// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/liquid_at_tip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace artus {

std::optional<RegionId> liquid_at_tip(const HapticSnapshot& snapshot) noexcept {
  constexpr double kNear = 1e-3;  // m; assumed: half of a bevel
  constexpr double kDrop = 1e-8;  // m^3, of less nobody speaks
  if (snapshot.inserted == 0) return std::nullopt;
  const auto& tip = snapshot.X_JN.position;
  for (std::size_t k = 0; k < std::min<std::size_t>(snapshot.n_sites, kMaxSites); ++k) {
    const InjectedSite& site = snapshot.sites[k];
    if (!(site.volume > kDrop)) continue;
    const double radius = std::cbrt(site.volume * 3 / (4 * std::numbers::pi));
    const double away =
        std::hypot(tip[0] - site.p_J[0], tip[1] - site.p_J[1], tip[2] - site.p_J[2]);
    if (away <= std::max(radius, kNear)) return static_cast<RegionId>(site.region);
  }
  return std::nullopt;
}

}  // namespace artus
