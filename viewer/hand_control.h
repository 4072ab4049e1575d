// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <variant>

#include "sim/device_hand.h"

namespace artus {

/// One thing that a person did; made by the window system or by a script, so that both go the same
/// way. Keys are capital letters, digits, or names: ESCAPE, SPACE, F1.
struct KeyEvent {
  std::string key;
};
struct MoveEvent {
  double x = 0;  ///< pixels from the window's left
  double y = 0;  ///< pixels from its top
};
struct ButtonEvent {
  int button = 0;  ///< 0 left, 1 right, 2 middle
  bool down = false;
};
struct ScrollEvent {
  double notches = 0;
  bool fine = false;  ///< shift is held: a tenth
};
using UserEvent = std::variant<KeyEvent, MoveEvent, ButtonEvent, ScrollEvent>;

/// What the mouse holds.
enum class Grab { nothing, needle, probe };

/// Turns mouse and keyboard into where needle and probe shall be. Pure: no window, no clock. With
/// the needle grabbed, the wheel pushes it along its axis and the mouse turns it about the point
/// where that axis meets the skin, or moves it sideways while it is outside; with the probe
/// grabbed, the mouse slides it on the body and the wheel turns it about its own axis.
class HandControl {
 public:
  static constexpr double kPush = 0.5e-3;                      ///< m a notch
  static constexpr double kSlide = 0.1e-3;                     ///< m a pixel
  static constexpr double kTurn = 0.1 * 0.017453292519943295;  ///< rad a pixel

  explicit HandControl(const HandTarget& start) : start_(start), target_(start) {}

  /// True when the event was taken. `inserted`: the needle is in the body.
  bool handle(const UserEvent& event, bool inserted);
  [[nodiscard]] Grab grab() const noexcept { return grab_; }
  [[nodiscard]] const HandTarget& target() const noexcept { return target_; }
  void set_target(const HandTarget& target) noexcept { target_ = target; }

 private:
  bool handle_key(const std::string& key);
  void drag(double dx, double dy, bool inserted);
  void push(double length);

  HandTarget start_;
  HandTarget target_;
  Grab grab_ = Grab::nothing;
  bool have_cursor_ = false;
  double x_ = 0;
  double y_ = 0;
  double depth_ = 10e-3;  // m that the tip is beyond the pivot; negative: before it
};

}  // namespace artus
