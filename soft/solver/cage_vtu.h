// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>

#include "artus/core/result.h"
#include "artus/detail/soft/solver/deformed_body.h"

namespace artus {

/// Writes the cage as a VTK unstructured grid for ParaView: nodes at rest in mm, frame J, with
/// their displacement (mm); of each cube the volume's ratio J, the pressure (Pa), the Green strain
/// at its centre (9) and the shear modulus (Pa). Errors: unreadable.
[[nodiscard]] Result<void> write_vtu(const DeformedBody& body, const std::filesystem::path& file);

}  // namespace artus
