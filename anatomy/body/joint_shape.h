// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/body/joint_parameter.h"

namespace artus {

/// The part of `folder`/joint.toml, with the `variants` that are chosen and of `patient`, that
/// shapes the body, as text that is the same for the same content: without comments, title, side,
/// axes, landmarks, poses, injections, spaces, fibre axes and the tissues' values. Two joint files
/// of one shape text make the same tetrahedra from the same surfaces. A key that this version does
/// not know counts as shaping. Errors: not_found, unreadable, malformed, invalid (a variant).
[[nodiscard]] Result<std::string> read_joint_shape(const std::filesystem::path& folder,
                                                   const std::vector<std::string>& variants = {},
                                                   const std::vector<PatientValue>& patient = {});

}  // namespace artus
