// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <vector>

#include "artus/detail/anatomy/import/imported_joint.h"

namespace artus {

/// Makes a joint of other people's files: one label volume; several masks of one grid, each a
/// structure named by its file (as TotalSegmentator writes them; what stands first keeps an
/// overlap); or surfaces and scenes, each part a structure. What a file is, its first bytes say.
/// Errors: those of the readers; invalid (volumes beside surfaces, masks of different grids).
[[nodiscard]] Result<ImportedJoint> import_files(const std::vector<std::filesystem::path>& files,
                                                 const ImportOptions& options,
                                                 const Progress& progress = {});

/// Masks as one label volume. Errors: invalid (another grid, more than one label in a file), naming
/// the file. Requires: one name for each volume, at least one.
[[nodiscard]] Result<LabelVolume> join_masks(const std::vector<ImageVolume>& masks,
                                             const std::vector<std::string>& names);

}  // namespace artus
