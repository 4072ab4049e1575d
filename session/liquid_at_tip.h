// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/detail/simulation/records.h"

namespace artus {

/// The place whose liquid the tip lies in, by its region: within the ball of that volume around
/// where it came out, or 1 mm of it. nullopt: in tissue, or the needle is out. Layers along the
/// needle are as they were before the liquid, so the tip's region alone names tissue there.
[[nodiscard]] std::optional<RegionId> liquid_at_tip(const HapticSnapshot& snapshot) noexcept;

}  // namespace artus
