// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/viewer/window.h"

#include <memory>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>

#include <GLFW/glfw3.h>

#include "artus/viewer/gui_context.h"
#include "artus/viewer/window_loop.h"

namespace artus {
namespace {

struct WindowCloser {
  void operator()(GLFWwindow* window) const noexcept { glfwDestroyWindow(window); }
};

/// GLFW for as long as it lives.
struct Library {
  bool ready = glfwInit() == GLFW_TRUE;
  Library() = default;
  ~Library() {
    if (ready) glfwTerminate();
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

/// The picture comes after haptics and imaging; so do the threads that the graphics driver starts.
/// Where imaging could not be made more urgent than usual, the window is made less.
void yield_to_imaging() {
  const auto self = static_cast<id_t>(gettid());
  const bool may_be_urgent = setpriority(PRIO_PROCESS, self, -1) == 0;
  setpriority(PRIO_PROCESS, self, may_be_urgent ? 0 : 10);
}

}  // namespace

Result<void> run_window(Session& session, HandDevice* hand, const HandTarget& start,
                        const WindowOptions& options, WindowReport& report) {
  yield_to_imaging();
  const Library library;
  if (!library.ready)
    return fail(ErrorCode::failed,
                "there is no display: at a desk, run it from a graphical session (over ssh: ssh "
                "-X); in CI or without a screen: xvfb-run -a artus view ...; without a window: "
                "artus serve",
                "DISPLAY");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  const std::unique_ptr<GLFWwindow, WindowCloser> window(
      glfwCreateWindow(options.width, options.height, "artus", nullptr, nullptr));
  if (!window)
    return fail(ErrorCode::failed,
                "the display has no OpenGL 3.3: install a driver, or LIBGL_ALWAYS_SOFTWARE=1");
  glfwMakeContextCurrent(window.get());
  glfwSwapInterval(0);
  const GuiContext gui;
  auto joint = JointView::make(session.scene().joint(), session.params().transducer.width,
                               needle_length_of(session.params()));
  ARTUS_TRY(joint);
  WindowLoop loop(window.get(), std::move(*joint), session, hand, start, options);
  ARTUS_TRY(loop.prepare());
  return loop.run(report);
}

}  // namespace artus
