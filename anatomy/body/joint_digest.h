// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

namespace artus {

struct CompiledJoint;

/// 16 hex digits over all that is in the joint: tissues with their values, regions, planned lines
/// and mesh. The same text means the same body and the same results. Cost: as writing it.
[[nodiscard]] std::string compute_joint_digest(const CompiledJoint& joint);

}  // namespace artus
