// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <utility>
#include <vector>

#include "artus/viewer/gamepad.h"
#include "artus/viewer/user_event.h"

struct GLFWwindow;

namespace artus {

/// Collects what a person does at a window of GLFW. Must outlive the window's last event; one a
/// window (it takes the window's user pointer).
class WindowEvents {
 public:
  explicit WindowEvents(GLFWwindow* window);
  ~WindowEvents() = default;
  WindowEvents(const WindowEvents&) = delete;
  WindowEvents& operator=(const WindowEvents&) = delete;

  /// What happened since the last call; `elapsed`: s since then, for a gamepad's sticks.
  [[nodiscard]] std::vector<UserEvent> take(double elapsed);
  /// While something is held the mouse moves without bounds and without a pointer.
  void hold_cursor(bool held);
  /// Name of the first gamepad; null when there is none.
  [[nodiscard]] static const char* gamepad_name();

  template <class Event>
  void add(Event event) {
    events_.emplace_back(std::in_place_type<Event>, std::move(event));
  }
  void set_shift(bool shift) noexcept { shift_ = shift; }
  [[nodiscard]] bool shift() const noexcept { return shift_; }

 private:
  GLFWwindow* window_;
  std::vector<UserEvent> events_;
  PadState pad_;
  bool shift_ = false;
  bool held_ = false;
};

}  // namespace artus
