// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/gamepad.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

/// Sticks rest a little off their middle; beyond that the way out is scaled back to 0 .. 1 and
/// squared, so that small motions are fine ones.
double shaped(double axis) {
  constexpr double kDead = 0.15;
  const double out = std::clamp((std::abs(axis) - kDead) / (1 - kDead), 0.0, 1.0);
  return std::copysign(out * out, axis);
}

}  // namespace

std::vector<UserEvent> events_of(const PadState& now, const PadState& before, double seconds) {
  constexpr std::array<Action, PadState::n_buttons> kActions{
      Action::choose_entry, Action::explore, Action::freeze,      Action::reset,
      Action::pause,        Action::finish,  Action::take_plunger};
  std::vector<UserEvent> events;
  for (std::size_t i = 0; i < kActions.size(); ++i) {
    if (now.buttons[i] && !before.buttons[i]) events.emplace_back(ActionEvent{kActions[i]});
  }
  PadEvent pad;
  pad.left_x = shaped(now.left[0]);
  pad.left_y = shaped(now.left[1]);
  pad.right_x = shaped(now.right[0]);
  pad.right_y = shaped(now.right[1]);
  pad.push = shaped((now.right_trigger - now.left_trigger) / 2);
  pad.seconds = seconds;
  if (pad.left_x != 0 || pad.left_y != 0 || pad.right_x != 0 || pad.right_y != 0 || pad.push != 0 ||
      shaped((before.right_trigger - before.left_trigger) / 2) != 0)  // so that a release is told
    events.emplace_back(pad);
  return events;
}

}  // namespace artus
