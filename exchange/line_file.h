// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include "artus/core/result.h"
#include "artus/dataset/sweep.h"

namespace artus {

/// How lines before the envelope become a file with this ending: "npz", or "uff", "h5" and "hdf5"
/// for the UltraSound ToolBox. Errors: unsupported, naming `flag` (another ending; built without
/// HDF5).
[[nodiscard]] Result<LineFile> line_file_of(const std::string& ending, const std::string& flag);
/// The same of a file's name.
[[nodiscard]] Result<LineFile> line_file_of(const std::filesystem::path& file,
                                            const std::string& flag);

}  // namespace artus
