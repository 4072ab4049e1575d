// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/pages/page_gui.h"

#include <algorithm>
#include <cmath>

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <GLFW/glfw3.h>

namespace artus {

PageGui::PageGui(Screen& screen, const PageOptions& options)
    : screen_(screen), options_(options), events_(screen.window()) {}

Result<void> PageGui::begin(const std::string& page, bool waits) {
  waits_ = waits;
  steps_.erase(steps_.begin(), steps_.begin() + static_cast<std::ptrdiff_t>(next_step_));
  next_step_ = 0;
  waited_ = 0;
  if (options_.script == nullptr || page.empty()) return {};
  auto steps = options_.script->take(page);
  ARTUS_TRY(steps);
  steps_ = std::move(*steps);
  return {};
}

// Letters follow the window's size and the screen's resolution.
void PageGui::fit() {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(screen_.window(), &width, &height);
  const float scale = find_gui_scale(screen_.window(), options_.font_scale);
  if (std::abs(scale - scale_) > 0.01F) {
    set_gui_scale(scale);
    scale_ = scale;
  }
  ImGui::GetIO().DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  ImGui_ImplOpenGL3_NewFrame();
}

void PageGui::feed(const UserEvent& event, const std::function<void(const UserEvent&)>& act) {
  ImGuiIO& io = ImGui::GetIO();
  if (const auto* move = std::get_if<MoveEvent>(&event)) {
    io.MousePos = ImVec2(static_cast<float>(move->x), static_cast<float>(move->y));
  } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
    if (button->button >= 0 && button->button < 3) io.MouseDown[button->button] = button->down;
  } else if (const auto* scroll = std::get_if<ScrollEvent>(&event)) {
    io.MouseWheel += static_cast<float>(scroll->notches);
  } else if (const auto* key = std::get_if<KeyEvent>(&event)) {
    act(ActionEvent{options_.keys.find(key->key, key->shift), key->shift});
  } else {
    act(event);
  }
}

void PageGui::pass(double elapsed, const std::function<void()>& look) {
  ImGuiIO& io = ImGui::GetIO();
  io.DeltaTime = static_cast<float>(std::clamp(elapsed, 1e-4, 1.0));
  ImGui::NewFrame();
  look();
  ImGui::EndFrame();
  io.MouseWheel = 0;
}

/// True while the next step is one that takes time, and its time is not over.
bool PageGui::script_waits(double elapsed) {
  const auto* wait = std::get_if<WaitStep>(&steps_[next_step_]);
  if (wait == nullptr) return false;
  waited_ += elapsed;
  if (waited_ < wait->seconds) return true;
  waited_ = 0;
  return false;
}

void PageGui::run_script(double elapsed, const std::function<void(const UserEvent&)>& act,
                         const std::function<void()>& look, const std::function<bool()>& over) {
  while (next_step_ < steps_.size() && !over()) {
    if (script_waits(elapsed)) return;
    elapsed = 0;
    const ScriptStep& step = steps_[next_step_++];
    if (const auto* shot = std::get_if<ScreenshotStep>(&step)) {
      wanted_.push_back(shot->file);
      return;  // what follows is not on that picture
    }
    if (const auto* event = std::get_if<UserEvent>(&step)) {
      feed(*event, act);
      pass(1e-3, look);
    }
  }
}

Result<void> PageGui::show() {
  ImGui::Render();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  glViewport(0, 0, static_cast<int>(size.x), static_cast<int>(size.y));
  glClearColor(0.05F, 0.05F, 0.06F, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  for (const std::filesystem::path& file : std::exchange(wanted_, {}))
    ARTUS_TRY(save_screen(screen_.window(), file));
  glfwSwapBuffers(screen_.window());
  return {};
}

Result<bool> PageGui::run(const std::function<void(const UserEvent&)>& act,
                          const std::function<void()>& look, const std::function<bool()>& over) {
  constexpr double kPeriod = 1.0 / 30;  // s
  const bool scripted = options_.script != nullptr && options_.script->given();
  const bool had_steps = !steps_.empty();
  double before = glfwGetTime();
  fit();
  pass(kPeriod, look);
  while (glfwWindowShouldClose(screen_.window()) == GLFW_FALSE) {
    if (options_.asked_to_close && options_.asked_to_close()) return true;
    const double now = glfwGetTime();
    const double elapsed = now - before;
    before = now;
    fit();
    for (const std::vector<TimedEvent>& group : events_.take(elapsed)) {
      if (scripted) continue;  // a script is alone at the window
      for (const TimedEvent& event : group) feed(event.event, act);
      pass(1e-3, look);
    }
    if (!waits_) run_script(elapsed, act, look, over);
    pass(elapsed, look);
    ARTUS_TRY(show());
    if (over()) return false;
    if (scripted && !waits_ && next_step_ >= steps_.size() && wanted_.empty()) {
      if (options_.script->over()) return true;
      if (had_steps)
        return fail(ErrorCode::failed, "its steps end, and nothing was chosen", "script");
    }
    events_.wait(kPeriod - (glfwGetTime() - now));
  }
  return true;
}

}  // namespace artus
