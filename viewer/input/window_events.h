// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "artus/detail/viewer/input/event_queue.h"
#include "artus/detail/viewer/input/gamepad.h"
#include "artus/detail/viewer/input/key_map.h"

struct GLFWwindow;

namespace artus {

/// Collects what a person does at a window of GLFW while it lives; one a window at a time (it takes
/// the window's user pointer). Leaves the window with its pointer and without a listener.
class WindowEvents {
 public:
  explicit WindowEvents(GLFWwindow* window);
  ~WindowEvents();
  WindowEvents(const WindowEvents&) = delete;
  WindowEvents& operator=(const WindowEvents&) = delete;

  /// Waits for `seconds`, and takes what happens meanwhile as it happens.
  void wait(double seconds);
  /// What happened since the last call, in groups for one look each; `elapsed`: s since then, for a
  /// gamepad's sticks.
  [[nodiscard]] std::vector<std::vector<TimedEvent>> take(double elapsed);
  /// While something is held the mouse moves without bounds and without a pointer.
  void hold_cursor(bool held);
  /// The left button is where the right one was.
  void set_left_handed(bool left_handed) noexcept { left_handed_ = left_handed; }
  /// Name of the first gamepad; null when there is none.
  [[nodiscard]] static const char* gamepad_name();

  // For the window system's callbacks.
  void add(UserEvent event);
  void set_modifiers(int modifiers) noexcept { modifiers_ = modifiers; }
  [[nodiscard]] bool shift() const noexcept;
  [[nodiscard]] bool ctrl() const noexcept;
  [[nodiscard]] bool hidden() const noexcept { return held_; }
  [[nodiscard]] int button(int button) const noexcept {
    return left_handed_ && button < 2 ? 1 - button : button;
  }

 private:
  GLFWwindow* window_;
  EventQueue queue_;
  PadState pad_;
  int modifiers_ = 0;
  bool held_ = false;
  bool left_handed_ = false;
};

/// How the keys lie, as the window system says. Requires: GLFW runs.
[[nodiscard]] Keyboard find_keyboard();

}  // namespace artus
