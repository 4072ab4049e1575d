// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/soft/liquid/injected_body.h"

namespace artus {

/// Where all of the liquid is drawn. What parts a region that it is told to lie beside does so at
/// the region's nearest point; what parts two at one place is a pocket in the one that has more of
/// it. What parts tissue beside a cavity, and is so thick that less than half a millimetre would be
/// left between them, tears that and goes into the cavity. What is more than a space holds
/// (SpaceLaw::rupture) tears the nearest tissue around it toward the skin and parts that, drawn to
/// 1 ml; without such tissue it stays. What is more than a layer of fat or skin has room for
/// (room_at) spreads in it and is left out. What is less, and yet more than the body has room for
/// (OpenedSpace::max_volume), is in parts of the space that the body does not have, as a joint's
/// other recesses or the length of a sheath, and is left out. Places of the same space count
/// together. Cost: linear in the joint's interfaces for each place in tissue and each space that is
/// too full.
[[nodiscard]] std::vector<Injected> with_overflow(const OpenedSpaces& spaces,
                                                  std::vector<Injected> places);

}  // namespace artus
