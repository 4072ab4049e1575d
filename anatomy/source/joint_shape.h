// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/detail/core/toml_table.h"

namespace artus {

/// What of a joint file's table shapes the body, as text that is the same for the same content:
/// without comments, title, side, axes, landmarks, poses, injections, spaces, fibre axes and the
/// tissues' values. Two joint files of one shape make the same tetrahedra from the same surfaces. A
/// key that this version does not know counts as shaping. Requires: variants are chosen and the
/// patient applied (choose_variants, apply_patient).
[[nodiscard]] std::string to_joint_shape(toml::table joint);

}  // namespace artus
