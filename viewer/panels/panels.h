// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include <imgui.h>

#include "artus/detail/viewer/joint3d/colours.h"
#include "artus/detail/viewer/joint3d/joint_view.h"
#include "artus/detail/viewer/panels/view_state.h"

namespace artus {

/// A panel between two lines of code: put where the layout has it, and the layout told when a
/// person moved it. Nothing is drawn in a panel that is not shown.
class PanelScope {
 public:
  PanelScope(Panel panel, const char* title, ViewState& state, int flags = 0);
  ~PanelScope();
  PanelScope(const PanelScope&) = delete;
  PanelScope& operator=(const PanelScope&) = delete;
  explicit operator bool() const noexcept { return shown_; }

 private:
  bool begun_ = false;
  bool shown_ = false;
};

void draw_guide_panel(const PanelInput& in, ViewState& state);
void draw_welcome(const PanelInput& in, ViewState& state);
void draw_joint_panel(const PanelInput& in, ViewState& state, JointView& view, JointArea& area);
void draw_image_panel(const PanelInput& in, ViewState& state);
void draw_scanner_panel(const PanelInput& in, ViewState& state);
void draw_force_panel(const PanelInput& in, ViewState& state);
void draw_rates_panel(const PanelInput& in, ViewState& state);
void draw_session_panel(const PanelInput& in, ViewState& state);
void draw_tissue_panel(const PanelInput& in, ViewState& state, JointView& view);
/// A task's steps and clock, in the session panel's place; and its patient, in the tissues'.
void draw_lesson_panel(const PanelInput& in, ViewState& state);
void draw_patient_panel(const PanelInput& in, ViewState& state);
/// Lines of another panel: the syringe, once it is used; and what the patient says of it.
void draw_syringe(const PanelInput& in, const ViewState& state);
void draw_patient_words(const PanelInput& in, const ViewState& state);
void draw_help(const PanelInput& in, ViewState& state);

/// Text that is read on any ground: in the overlay's colour with a dark outline.
void outlined_text(ImDrawList* list, const ImVec2& at, const std::string& text);
/// A name and the point that it names, pixels from a picture's corner.
struct NamedPoint {
  std::string name;
  float x;
  float y;
};
/// Names in a picture of `size` at `corner`, each in the middle of its point as far as there is
/// room.
void draw_names(ImDrawList* list, const ImVec2& corner, const ImVec2& size,
                const std::vector<NamedPoint>& names);
void outlined_line(ImDrawList* list, const ImVec2& a, const ImVec2& b);
[[nodiscard]] ImU32 to_imgui(const Rgb& colour, int alpha = 255) noexcept;
[[nodiscard]] ImTextureID to_imgui(unsigned texture) noexcept;
/// A sentence in the window's language.
[[nodiscard]] inline const char* translate(const ViewState& state, const char* english) noexcept {
  return translate(state.language, english);
}
/// "freeze (F)": a button's text with its key. After ### stands a name of no language.
[[nodiscard]] std::string with_key(const ViewState& state, const char* which, Action action);
/// A button that asks for an action; bright while what it asks for is `on`.
void action_button(ViewState& state, const char* which, Action action, bool on = false);

/// What the bits of a tick's status say, for people; "all well" for none.
[[nodiscard]] std::string describe_status(Language language, std::uint32_t status);

}  // namespace artus
