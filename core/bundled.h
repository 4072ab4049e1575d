// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>

namespace artus {

/// Where the file or folder `relative` that comes with artus is ("meshes/shoulder"); empty:
/// nowhere. Looked for, in this order: in the folder that the environment's ARTUS_DATA names; in
/// the folders above the program, or above the library that holds this code, from the nearest on:
/// in share/artus of each (an installation), then in itself (the tree it was built in); in the
/// current folder. Requires: a relative path. Errors: none. Cost: some look-ups of files.
[[nodiscard]] std::filesystem::path find_bundled(const std::filesystem::path& relative);

}  // namespace artus
