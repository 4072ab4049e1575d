// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <variant>

#include "artus/detail/viewer/input/key_map.h"

namespace artus {

/// One thing that a person did; made by the window system or by a script, so that both go the same
/// way. What a key means is the key map's.
struct KeyEvent {
  std::string key;  ///< the character that it types, as a capital letter, or a name: see KeyMap
  bool shift = false;
};
/// A wish however it was made: by a key, a button of the window or of a gamepad.
struct ActionEvent {
  Action action = Action::none;
  bool fine = false;  ///< a tenth as far
};
struct MoveEvent {
  double x = 0;       ///< pixels from the window's left
  double y = 0;       ///< pixels from its top
  bool fine = false;  ///< shift is held: what is in hand moves a tenth as far
  bool tilt = false;  ///< ctrl is held: the probe in hand tilts
  /// There is no pointer: only how far the mouse went means something.
  bool hidden = false;
};
struct ButtonEvent {
  int button = 0;  ///< 0 left, 1 right, 2 middle
  bool down = false;
  bool hidden = false;  ///< there is no pointer: it points at nothing
};
struct ScrollEvent {
  double notches = 0;
  bool fine = false;  ///< shift is held: a tenth
  bool tilt = false;  ///< ctrl is held: the probe in hand is pressed or lifted
};
/// A gamepad's sticks held for a while; each -1 to 1, right and down positive.
struct PadEvent {
  double left_x = 0;
  double left_y = 0;
  double right_x = 0;
  double right_y = 0;
  double push = 0;     ///< right trigger less left trigger
  double seconds = 0;  ///< for how long
};
using UserEvent =
    std::variant<KeyEvent, ActionEvent, MoveEvent, ButtonEvent, ScrollEvent, PadEvent>;

}  // namespace artus
