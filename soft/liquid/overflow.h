// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/soft/liquid/injected_body.h"

namespace artus {

/// Where all of the liquid is. What parts tissue beside a cavity, and is so thick that less than
/// half a millimetre would be left between them, tears that and goes into the cavity. What is more
/// than a space takes (OpenedSpace::max_volume) tears the nearest tissue around it toward the skin
/// and parts that, as a space does that is filled beyond what it holds. Places of the same space
/// count together. Without such tissue it stays. Cost: linear in the joint's interfaces for each
/// place in tissue and each space that is too full.
[[nodiscard]] std::vector<Injected> with_overflow(const OpenedSpaces& spaces,
                                                  std::vector<Injected> places);

}  // namespace artus
