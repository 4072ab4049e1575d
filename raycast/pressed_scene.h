// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>

#include "artus/detail/soft/solver/press.h"
#include "artus/raycast/scene.h"

namespace artus {

/// How far a probe is pressed: by a depth (m) or with a force (N on the hand).
struct PressGoal {
  std::optional<double> depth;
  std::optional<double> force;
};

/// A joint as it lies under a pressed probe, and the press that did it.
struct PressedScene {
  std::shared_ptr<const Scene> scene;  ///< carries the body of that instant (Scene::tissue)
  Press press;
};

/// Presses `face` once and keeps the result, for pictures and truth that need no motion. Requires:
/// one of the two, a depth of 0 or more, a force above 0. Errors: those of SoftBody::make and
/// press_with. Cost: seconds for a joint of 1e6 tetrahedra.
[[nodiscard]] Result<PressedScene> press_scene(std::shared_ptr<const CompiledJoint> joint,
                                               const Pose& X_JP, const PressGoal& goal,
                                               const ProbeFace& face = {});

}  // namespace artus
