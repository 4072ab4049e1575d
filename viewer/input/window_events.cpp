// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/window_events.h"

#include <array>
#include <string>
#include <utility>

#include <GLFW/glfw3.h>

namespace artus {
namespace {

WindowEvents& events_of(GLFWwindow* window) {
  return *static_cast<WindowEvents*>(glfwGetWindowUserPointer(window));
}

/// The character that a key types, as a capital letter; empty for keys that type none.
std::string typed_by(int key, int scancode) {
  const char* typed = glfwGetKeyName(key, scancode);
  std::string name = typed != nullptr ? typed : "";
  if (name.size() == 1 && name[0] >= 'a' && name[0] <= 'z')
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return name;
}

std::string name_of(int key, int scancode) {
  constexpr std::array<std::pair<int, const char*>, 14> kNamed{{{GLFW_KEY_ESCAPE, "ESCAPE"},
                                                                {GLFW_KEY_SPACE, "SPACE"},
                                                                {GLFW_KEY_HOME, "HOME"},
                                                                {GLFW_KEY_TAB, "TAB"},
                                                                {GLFW_KEY_ENTER, "ENTER"},
                                                                {GLFW_KEY_KP_ENTER, "ENTER"},
                                                                {GLFW_KEY_BACKSPACE, "BACKSPACE"},
                                                                {GLFW_KEY_LEFT, "LEFT"},
                                                                {GLFW_KEY_RIGHT, "RIGHT"},
                                                                {GLFW_KEY_UP, "UP"},
                                                                {GLFW_KEY_DOWN, "DOWN"},
                                                                {GLFW_KEY_PAGE_UP, "PAGE_UP"},
                                                                {GLFW_KEY_PAGE_DOWN, "PAGE_DOWN"},
                                                                {GLFW_KEY_UNKNOWN, ""}}};
  for (const auto& [known, name] : kNamed) {
    if (known == key) return name;
  }
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) return "F" + std::to_string(key - GLFW_KEY_F1 + 1);
  return typed_by(key, scancode);
}

bool is_shift(int key) {
  return key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT;
}
bool is_ctrl(int key) {
  return key == GLFW_KEY_LEFT_CONTROL || key == GLFW_KEY_RIGHT_CONTROL;
}

void on_key(GLFWwindow* window, int key, int scancode, int action, int mods) {
  WindowEvents& events = events_of(window);
  // X11 tells of a modifier's own key the state before it.
  const int own = is_shift(key) ? GLFW_MOD_SHIFT : is_ctrl(key) ? GLFW_MOD_CONTROL : 0;
  events.set_modifiers(action == GLFW_RELEASE ? mods & ~own : mods | own);
  if (action == GLFW_RELEASE) return;
  std::string name = name_of(key, scancode);
  if (!name.empty()) events.add(KeyEvent{std::move(name), events.shift()});
}

void on_move(GLFWwindow* window, double x, double y) {
  WindowEvents& events = events_of(window);
  events.add(MoveEvent{x, y, events.shift(), events.ctrl(), events.hidden()});
}

void on_button(GLFWwindow* window, int button, int action, int mods) {
  WindowEvents& events = events_of(window);
  events.set_modifiers(mods);
  events.add(ButtonEvent{events.button(button), action == GLFW_PRESS, events.hidden()});
}

void on_scroll(GLFWwindow* window, double /*x*/, double y) {
  WindowEvents& events = events_of(window);
  events.add(ScrollEvent{y, events.shift(), events.ctrl()});
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
  pad.buttons = {down(GLFW_GAMEPAD_BUTTON_A),           down(GLFW_GAMEPAD_BUTTON_B),
                 down(GLFW_GAMEPAD_BUTTON_X),           down(GLFW_GAMEPAD_BUTTON_Y),
                 down(GLFW_GAMEPAD_BUTTON_START),       down(GLFW_GAMEPAD_BUTTON_BACK),
                 down(GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER)};
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

WindowEvents::~WindowEvents() {
  hold_cursor(false);
  glfwSetKeyCallback(window_, nullptr);
  glfwSetCursorPosCallback(window_, nullptr);
  glfwSetMouseButtonCallback(window_, nullptr);
  glfwSetScrollCallback(window_, nullptr);
  glfwSetWindowUserPointer(window_, nullptr);
}

void WindowEvents::add(UserEvent event) {
  queue_.add(std::move(event), glfwGetTime());
}

bool WindowEvents::shift() const noexcept {
  return (modifiers_ & GLFW_MOD_SHIFT) != 0;
}

bool WindowEvents::ctrl() const noexcept {
  return (modifiers_ & GLFW_MOD_CONTROL) != 0;
}

void WindowEvents::wait(double seconds) {
  const double end = glfwGetTime() + seconds;
  for (double left = seconds; left > 1e-4; left = end - glfwGetTime()) glfwWaitEventsTimeout(left);
}

std::vector<std::vector<TimedEvent>> WindowEvents::take(double elapsed) {
  glfwPollEvents();
  const PadState pad = look_at_pad();
  for (UserEvent& event : artus::events_of(pad, pad_, elapsed)) add(std::move(event));
  pad_ = pad;
  return queue_.take_groups();
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

Keyboard find_keyboard() {
  return keyboard_of(typed_by(GLFW_KEY_Q, 0), typed_by(GLFW_KEY_Y, 0));
}

}  // namespace artus
