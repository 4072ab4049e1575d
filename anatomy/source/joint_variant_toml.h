// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/anatomy/source/joint_variant.h"
#include "artus/detail/core/toml_table.h"

namespace artus {

/// Makes a joint file's table that of the joint with the chosen variants: what says `variant` of
/// others is taken out, what a chosen [variant.NAME] says of region_of_interest, and one of `asked`
/// of probe, needle and injections, stands in the place of the joint's own, and no word of variants
/// is left. Chosen and not asked for is what a patient happens to have: the plan stays the joint's.
/// Problems: a variant that is asked for or named and not declared, an unknown key. Returns all
/// that are declared, in alphabetical order.
[[nodiscard]] std::vector<JointVariant> choose_variants(toml::table& joint,
                                                        const std::vector<std::string>& chosen,
                                                        const std::vector<std::string>& asked,
                                                        Problems& problems);

}  // namespace artus
