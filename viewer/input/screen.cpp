// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/screen.h"

#include <epoxy/gl.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include <GLFW/glfw3.h>

namespace artus {
namespace {

/// The picture comes after haptics and imaging; so do the threads that the graphics driver starts.
/// Where imaging could not be made more urgent than usual, the window is made less.
void yield_to_imaging() {
  const auto self = static_cast<id_t>(gettid());
  const bool may_be_urgent = setpriority(PRIO_PROCESS, self, -1) == 0;
  setpriority(PRIO_PROCESS, self, may_be_urgent ? 0 : 10);
}

}  // namespace

Result<std::unique_ptr<Screen>> Screen::open(int width, int height) {
  yield_to_imaging();
  std::unique_ptr<Screen> screen(new Screen);
  screen->ready_ = glfwInit() == GLFW_TRUE;
  if (!screen->ready_)
    return fail(ErrorCode::failed,
                "there is no display: at a desk, run it from a graphical session (over ssh: ssh "
                "-X); in CI or without a screen: xvfb-run -a artus view ...; without a window: "
                "artus serve",
                "DISPLAY");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  screen->window_ = glfwCreateWindow(width, height, "artus", nullptr, nullptr);
  if (screen->window_ == nullptr)
    return fail(ErrorCode::failed,
                "the display has no OpenGL 3.3: install a driver, or LIBGL_ALWAYS_SOFTWARE=1");
  glfwMakeContextCurrent(screen->window_);
  glfwSwapInterval(0);
  return screen;
}

Screen::~Screen() {
  if (window_ != nullptr) glfwDestroyWindow(window_);
  if (ready_) glfwTerminate();
}

Result<void> save_screen(GLFWwindow* window, const std::filesystem::path& file) {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window, &width, &height);
  cv::Mat picture(height, width, CV_8UC3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, width, height, GL_BGR, GL_UNSIGNED_BYTE, picture.data);
  cv::flip(picture, picture, 0);
  if (!cv::haveImageWriter(file.string()) || !cv::imwrite(file.string(), picture))
    return fail(ErrorCode::unreadable, "cannot write the picture", file.string());
  return {};
}

}  // namespace artus
