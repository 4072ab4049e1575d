// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/haptics/needle/needle_contact.h"
#include "artus/detail/haptics/plunger/plunger.h"

namespace artus {

/// Opening of a bevel along the needle for an outer diameter (m), m; assumed: 2.5 diameters.
[[nodiscard]] constexpr double bevel_length(double outer_diameter) noexcept {
  return 2.5 * outer_diameter;
}

/// m from the tip to the middle of its opening: where liquid leaves the needle.
[[nodiscard]] constexpr double bevel_middle(double outer_diameter) noexcept {
  return 0.5 * bevel_length(outer_diameter);
}

/// What a bevel needs to know of a joint's places.
struct BevelPlaces {
  std::vector<std::uint32_t> of_region;  ///< (n_regions), as JointSpaces has it
  std::vector<SpaceKind> kinds;          ///< (n_spaces)
};
[[nodiscard]] BevelPlaces make_bevel_places(const JointSpaces& spaces);

/// In which places the opening of a needle's bevel lies: that of the tip and one more, by the
/// bevel's length in each. Outside the body, in air. Where the tip is in a cavity or has passed
/// one, tissue within kHoldingFilm of it along the needle counts for the cavity: such a film tears.
/// So does what its liquid lifts off the tip: `lifted` m of tissue before a cavity, (n_spaces), or
/// none.
/// A thin layer between two others counts for what it takes of the bevel.
[[nodiscard]] ARTUS_REALTIME std::array<TipShare, 2> bevel_shares(
    const NeedleContact& contact, double bevel, const BevelPlaces& places,
    std::span<const double> lifted) noexcept;

}  // namespace artus
