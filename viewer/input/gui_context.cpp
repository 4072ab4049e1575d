// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/gui_context.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <GLFW/glfw3.h>

namespace artus {

GuiContext::GuiContext() {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // panel_layout.h keeps the places
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableGamepad;  // how arrows go from knob to knob
  io.BackendFlags |= ImGuiBackendFlags_HasGamepad;
  ImGui_ImplOpenGL3_Init("#version 330");
}

GuiContext::~GuiContext() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

void set_gui_scale(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  const char* font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  const float size = std::round(13 * scale);
  // Latin letters, and the dot of a running clip.
  static constexpr ImWchar kLetters[] = {0x20, 0xff, 0x152, 0x153, 0x25cf, 0x25cf, 0};  // NOLINT
  if (std::filesystem::exists(font)) {
    io.Fonts->AddFontFromFileTTF(font, size, nullptr, kLetters);
  } else {
    ImFontConfig config;
    config.SizePixels = size;
    io.Fonts->AddFontDefault(&config);
  }
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
  ImGui::GetStyle() = ImGuiStyle();
  ImGui::StyleColorsDark();
  ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 1;  // letters below do not shine through
  ImGui::GetStyle().ScaleAllSizes(scale);
}

float find_gui_scale(GLFWwindow* window, double requested) {
  float x = 1;
  float y = 1;
  glfwGetWindowContentScale(window, &x, &y);
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window, &width, &height);
  const float by_window =
      std::min(static_cast<float>(height) / 720.F, static_cast<float>(width) / 1280.F);
  const float asked = static_cast<float>(requested) * std::max(y, by_window);
  return std::clamp(asked, 0.7F, 5.F);
}

}  // namespace artus
