// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

struct GLFWwindow;

namespace artus {

/// Dear ImGui for as long as it lives. Fed by hand, so that a script's events and a person's are
/// the same.
class GuiContext {
 public:
  GuiContext();
  ~GuiContext();
  GuiContext(const GuiContext&) = delete;
  GuiContext& operator=(const GuiContext&) = delete;
};

/// Letters and sizes as large as `scale` (1: letters of 13 pixels). Not between a pass's begin and
/// end. Cost: some ms.
void set_gui_scale(float scale);

/// How large letters are to be: as the screen asks for, or as they are on a window of 720 lines,
/// times `wished`.
[[nodiscard]] float find_gui_scale(GLFWwindow* window, double requested);

}  // namespace artus
