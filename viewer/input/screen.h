// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>

#include "artus/core/result.h"

struct GLFWwindow;

namespace artus {

/// The window of the system's desktop with its OpenGL 3.3 context, in which pages, sessions and
/// reviews are shown one after the other. One at a time, from the main thread.
class Screen {
 public:
  /// `width`, `height`: pixels. Errors: failed (no display, no OpenGL 3.3), with what to do.
  [[nodiscard]] static Result<std::unique_ptr<Screen>> open(int width, int height);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  [[nodiscard]] GLFWwindow* window() const noexcept { return window_; }

 private:
  Screen() = default;
  bool ready_ = false;
  GLFWwindow* window_ = nullptr;
};

/// What is drawn but not yet shown, as a picture. Errors: unreadable (it cannot be written).
[[nodiscard]] Result<void> save_screen(GLFWwindow* window, const std::filesystem::path& file);

}  // namespace artus
