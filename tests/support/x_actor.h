// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <string>

namespace artus::test {

/// A person at an X display: what it does reaches windows as from a mouse and a keyboard (XTEST).
/// Without a window manager a window stands at the screen's corner, so that its pixels are the
/// screen's.
class XActor {
 public:
  /// Null when there is no display, or it has no XTEST.
  [[nodiscard]] static std::unique_ptr<XActor> open();
  ~XActor();
  XActor(const XActor&) = delete;
  XActor& operator=(const XActor&) = delete;

  void move(double x, double y);
  /// By so many pixels from where the pointer is.
  void move_by(int dx, int dy);
  /// 1 left, 2 middle, 3 right.
  void button(int which, bool down);
  /// Down, `ms` of time, up.
  void click(double x, double y, int ms);
  void drag(double x, double y, double to_x, double to_y);
  /// Positive: away from the person.
  void wheel(int notches);
  /// By its X name: "n", "Escape", "F1"; `modifier` is held meanwhile when it has a name.
  void key(const std::string& name, const std::string& modifier = {});
  /// The key at a place of the keyboard (its X keycode), whatever it types.
  void key_at(int keycode);
  /// The screen's upper left part as PNG.
  void save_screen(const std::filesystem::path& file, int width, int height);

 private:
  struct Impl;
  explicit XActor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace artus::test
