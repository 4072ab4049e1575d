// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/anatomy/body/holders.h"
#include "artus/detail/anatomy/compile/check/joint_check.h"

namespace artus {

/// What will hold the tissue of a joint that is not compiled yet: hard structures of which
/// something lies in the body and the region of interest (what is made from others counts), and the
/// faces where that region or a cut ends the body. Requires: `surfaces` of `file`.
[[nodiscard]] Holders find_holders(const JointFile& file, const PreparedSurfaces& surfaces);

/// One refusal when nothing does. Requires: as find_holders.
[[nodiscard]] std::vector<Finding> find_unheld(const JointFile& file,
                                               const PreparedSurfaces& surfaces);

}  // namespace artus
