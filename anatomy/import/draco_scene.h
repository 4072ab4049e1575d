// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "artus/core/result.h"

namespace artus {

/// Whether this build expands compressed scenes (libdraco).
[[nodiscard]] bool expands_draco() noexcept;

/// A binary glTF whose meshes are compressed by Draco (KHR_draco_mesh_compression), as one with the
/// same places and triangles and nothing compressed; normals and textures are dropped. Other bytes
/// come back as they are, and so do all in a build without libdraco. Errors: corrupt (a mesh that
/// cannot be expanded, views that lie outside of the file), naming `name`. Cost: linear. May throw
/// std::bad_alloc on hostile input, which the process that reads scenes catches.
[[nodiscard]] Result<std::string> expand_draco(std::string_view bytes, const std::string& name);

}  // namespace artus
