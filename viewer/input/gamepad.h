// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <vector>

#include "artus/detail/viewer/input/user_event.h"

namespace artus {

/// A gamepad as the window system reports it, in the layout that GLFW and SDL share.
struct PadState {
  enum Button { a, b, x, y, start, back, bumper, n_buttons };  // the right bumper
  std::array<double, 2> left{};   ///< stick, -1 to 1, right and down positive
  std::array<double, 2> right{};  ///< the same
  double left_trigger = -1;       ///< -1 free .. 1 pressed
  double right_trigger = -1;      ///< the same
  std::array<bool, n_buttons> buttons{};
};

/// What was done with the pad in `seconds` between two looks: the sticks beyond their dead zone,
/// and an action for each button that went down (A chooses the entry, B goes back to exploring, X
/// freezes, Y resets, start pauses, back ends a task, the right bumper puts the thumb on the
/// plunger). Pure.
[[nodiscard]] std::vector<UserEvent> events_of(const PadState& now, const PadState& before,
                                               double seconds);

}  // namespace artus
