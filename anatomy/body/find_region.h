// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string_view>

#include "artus/anatomy/compiled_joint.h"

namespace artus {

/// The region of the structure or filler `name`. Errors: not_found, with what the joint has.
[[nodiscard]] Result<RegionId> find_region(const CompiledJoint& joint, std::string_view name);

}  // namespace artus
