// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/imported_joint.h"

namespace artus {

/// Writes what an import made as one page to look at: the joint from two sides with and without its
/// skin, each structure as the file has it (faces of voxels) and as it became, a table of tissues
/// and volumes, what was made and not measured, what was left out. Errors: unreadable.
[[nodiscard]] Result<void> write_import_page(const ImportedJoint& joint,
                                             const std::filesystem::path& page);

}  // namespace artus
