// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/raycast/pressed_scene.h"

#include <utility>

#include "artus/detail/raycast/moving_scene.h"

namespace artus {

Result<PressedScene> press_scene(std::shared_ptr<const CompiledJoint> joint, const Pose& X_JP,
                                 const PressGoal& goal, const ProbeFace& face) {
  ARTUS_REQUIRE(goal.depth.has_value() != goal.force.has_value(), "a depth or a force");
  SoftBodyParams params;
  params.face = face;
  auto body = SoftBody::make(std::move(joint), X_JP, params);
  ARTUS_TRY(body);
  const auto press = goal.depth ? Result<Press>(press_by(*body, X_JP, *goal.depth))
                                : press_with(*body, X_JP, *goal.force);
  ARTUS_TRY(press);
  return PressedScene{make_scene(body->snapshot()), *press};
}

}  // namespace artus
