// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/training/scenario.h"
#include "artus/raycast/scene.h"

namespace artus {

/// The body that a scenario is played in: its gel, `joint` when one is given, else its joint as a
/// path or by its name under meshes/. Errors: those of load.
[[nodiscard]] Result<std::shared_ptr<const Scene>> load_scene(const Scenario& scenario,
                                                              const std::filesystem::path& joint,
                                                              const Progress& progress);

}  // namespace artus
