// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include <imgui.h>

namespace artus {

/// An opaque colour of text, 0 to 1 each, that is there at compile time, as an ImVec4 cannot be.
struct Shade {
  float red, green, blue;
  operator ImVec4() const { return {red, green, blue, 1}; }  // NOLINT(google-explicit-constructor)
};

/// A text in one colour, as many lines as the window's width, or the wrap that is pushed, asks for.
inline void wrapped_text(const std::string& said, const ImVec4& colour) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextWrapped("%s", said.c_str());
  ImGui::PopStyleColor();
}

}  // namespace artus
