// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/viewer/window_events.h"

#include <utility>

#include <GLFW/glfw3.h>

namespace artus {
namespace {

WindowEvents& events_of(GLFWwindow* window) {
  return *static_cast<WindowEvents*>(glfwGetWindowUserPointer(window));
}

std::string name_of(int key) {
  if ((key >= GLFW_KEY_A && key <= GLFW_KEY_Z) || (key >= GLFW_KEY_0 && key <= GLFW_KEY_9))
    return {static_cast<char>(key)};
  switch (key) {
    case GLFW_KEY_ESCAPE:
      return "ESCAPE";
    case GLFW_KEY_SPACE:
      return "SPACE";
    case GLFW_KEY_HOME:
      return "HOME";
    case GLFW_KEY_F1:
      return "F1";
    default:
      return {};
  }
}

void on_key(GLFWwindow* window, int key, int /*scancode*/, int action, int /*mods*/) {
  WindowEvents& events = events_of(window);
  if (key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT)
    events.set_shift(action != GLFW_RELEASE);
  if (action == GLFW_RELEASE) return;
  std::string name = name_of(key);
  if (!name.empty()) events.add(KeyEvent{std::move(name)});
}

void on_move(GLFWwindow* window, double x, double y) {
  WindowEvents& events = events_of(window);
  events.add(MoveEvent{x, y, events.shift()});
}

void on_button(GLFWwindow* window, int button, int action, int /*mods*/) {
  events_of(window).add(ButtonEvent{button, action == GLFW_PRESS});
}

void on_scroll(GLFWwindow* window, double /*x*/, double y) {
  WindowEvents& events = events_of(window);
  events.add(ScrollEvent{y, events.shift()});
}

PadState look_at_pad() {
  PadState pad;
  GLFWgamepadstate state{};
  if (glfwGetGamepadState(GLFW_JOYSTICK_1, &state) == GLFW_FALSE) return pad;
  pad.left = {state.axes[GLFW_GAMEPAD_AXIS_LEFT_X], state.axes[GLFW_GAMEPAD_AXIS_LEFT_Y]};
  pad.right = {state.axes[GLFW_GAMEPAD_AXIS_RIGHT_X], state.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y]};
  pad.left_trigger = state.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER];
  pad.right_trigger = state.axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER];
  const auto down = [&state](int button) {
    return state.buttons[button] == GLFW_PRESS;
  };
  pad.buttons = {down(GLFW_GAMEPAD_BUTTON_A), down(GLFW_GAMEPAD_BUTTON_B),
                 down(GLFW_GAMEPAD_BUTTON_X), down(GLFW_GAMEPAD_BUTTON_Y),
                 down(GLFW_GAMEPAD_BUTTON_START)};
  return pad;
}

}  // namespace

WindowEvents::WindowEvents(GLFWwindow* window) : window_(window) {
  glfwSetWindowUserPointer(window, this);
  glfwSetKeyCallback(window, on_key);
  glfwSetCursorPosCallback(window, on_move);
  glfwSetMouseButtonCallback(window, on_button);
  glfwSetScrollCallback(window, on_scroll);
}

std::vector<UserEvent> WindowEvents::take(double elapsed) {
  glfwPollEvents();
  std::vector<UserEvent> taken = std::exchange(events_, {});
  const PadState pad = look_at_pad();
  for (UserEvent& event : artus::events_of(pad, pad_, elapsed)) taken.push_back(std::move(event));
  pad_ = pad;
  return taken;
}

void WindowEvents::hold_cursor(bool held) {
  if (held == held_) return;
  held_ = held;
  glfwSetInputMode(window_, GLFW_CURSOR, held ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
}

const char* WindowEvents::gamepad_name() {
  return glfwJoystickIsGamepad(GLFW_JOYSTICK_1) == GLFW_TRUE ? glfwGetGamepadName(GLFW_JOYSTICK_1)
                                                             : nullptr;
}

}  // namespace artus
