// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "artus/detail/anatomy/import/scene_parts.h"

namespace artus {

/// The parts of a scene by libassimp, in a process of its own, so that a file on which the library
/// fails or takes more than 120 s or 4 GB costs that process alone. Nodes' transforms are applied;
/// glTF is in metres with y up, others in `unit`. Errors: malformed (what the library says),
/// unsupported (a build without it, a file that needs others beside it), failed (it crashed).
[[nodiscard]] Result<std::vector<ScenePart>> read_scene(std::string_view bytes,
                                                        const std::string& name, double unit);

/// The bytes of parts and back, as they go from one process to the other. Errors: corrupt.
[[nodiscard]] std::string pack_parts(const std::vector<ScenePart>& parts);
[[nodiscard]] Result<std::vector<ScenePart>> unpack_parts(std::string_view bytes,
                                                          const std::string& name);

}  // namespace artus
