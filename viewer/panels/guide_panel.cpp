// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>

#include "artus/detail/viewer/panels/help_rows.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/panels/shade.h"
#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

constexpr Shade kGood{0.55F, 0.95F, 0.55F};
constexpr Shade kWarning{1, 0.72F, 0.35F};
constexpr Shade kGoal{1, 0.88F, 0.4F};

/// In a narrow window one panel stands beside the picture; here it is chosen.
void draw_choice_of_panels(ViewState& state) {
  constexpr std::array<std::pair<Panel, Text>, 6> kChoices{{{Panel::joint, Text::panel_joint},
                                                            {Panel::scanner, Text::panel_scanner},
                                                            {Panel::session, Text::panel_session},
                                                            {Panel::tissues, Text::panel_tissues},
                                                            {Panel::force, Text::panel_force},
                                                            {Panel::rates, Text::panel_rates}}};
  const float right = ImGui::GetWindowContentRegionMax().x;
  for (const auto& [panel, name] : kChoices) {
    if (state.expert && (panel == Panel::joint || panel == Panel::tissues)) continue;
    const float width =
        ImGui::CalcTextSize(tell(state, name)).x + 2 * ImGui::GetStyle().FramePadding.x;
    if (ImGui::GetCursorPosX() + width > right && ImGui::GetCursorPosX() > width) ImGui::NewLine();
    const bool chosen = state.layout.chosen() == panel;
    if (chosen)
      ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (ImGui::SmallButton(tell(state, name))) state.layout.choose(panel);
    if (chosen) ImGui::PopStyleColor();
    ImGui::SameLine();
  }
  ImGui::NewLine();
}

/// The goal and the next step; in expert mode only what is wrong.
void draw_task(const PanelInput& in, const ViewState& state) {
  if (!state.expert) wrapped_text(in.goal, kGoal);
  const bool well = in.peer == PeerState::alive;
  if (!state.expert || !well)
    wrapped_text(in.next, well ? ImGui::GetStyleColorVec4(ImGuiCol_Text) : ImVec4(kWarning));
}

/// That a clip runs, and the last message.
void draw_message(const PanelInput& in, const ViewState& state) {
  ImGui::PushTextWrapPos(0);
  if (state.wants_clip)
    ImGui::TextColored(ImVec4(1, 0.3F, 0.3F, 1), "\xe2\x97\x8f %s %s s", tell(state, Text::rec),
                       number(state.language, in.clip_seconds, 1).c_str());
  if (!state.message.empty()) wrapped_text(state.message, kGood);
  ImGui::PopTextWrapPos();
}

}  // namespace

void draw_guide_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::guide, Text::panel_guide, state,
                         ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoCollapse);
  if (!scope) return;
  const bool narrow = state.layout.narrow();
  const float left =
      (narrow ? 1.F : PanelLayout::kGuideShare) * ImGui::GetWindowContentRegionMax().x;
  const ImVec2 top = ImGui::GetCursorPos();
  ImGui::PushTextWrapPos(left);
  draw_task(in, state);
  ImGui::PopTextWrapPos();
  if (!narrow) ImGui::SetCursorPos(ImVec2(left + ImGui::GetFontSize(), top.y));
  if (!narrow) ImGui::BeginGroup();
  draw_message(in, state);
  if (!narrow) ImGui::EndGroup();
  if (state.layout.narrow()) draw_choice_of_panels(state);
}

// Where the plots are still empty: the picture and the 3D view stay free.
void draw_welcome(const PanelInput& in, ViewState& state) {
  if (!state.welcome) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const ImVec2 middle = state.layout.narrow() ? ImVec2(size.x / 2, 0.62F * size.y)
                                              : ImVec2(0.295F * size.x, 0.83F * size.y);
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, ImVec2(0.5F, 0.5F));
  ImGui::PushStyleColor(ImGuiCol_Border, ImVec4(kGoal));
  ImGui::Begin("###welcome", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ImGui::TextUnformatted(tell(state, Text::choice_title));
  action_button(state, Text::choice_explore, Action::take_probe);
  const auto& injections = in.session->scene().joint().injections;
  for (std::size_t i = 0; in.has_hand && i < injections.size(); ++i) {
    const std::string name =
        fill(tell(state, Text::choice_inject),
             {std::to_string(i + 1), clinical_name(state.language, injections[i].name)});
    if (ImGui::Button(name.c_str())) state.planned = i;
    if (i % 2 == 0 && i + 1 < injections.size() && !state.layout.narrow()) ImGui::SameLine();
  }
  if (state.offers_training && ImGui::Button(tell(state, Text::choice_train)))
    state.quit = state.training = true;
  action_button(state, Text::choice_help, Action::help);
  ImGui::End();
  ImGui::PopStyleColor();
}

void draw_help(const PanelInput& in, ViewState& state) {
  if (!state.help) return;
  std::vector<HelpRow> rows = help_rows(state.keys, state.language);
  rows.push_back({tell(state, Text::key_ctrl), tell(state, Text::help_tilt)});
  rows.push_back({tell(state, Text::key_shift), tell(state, Text::help_shift)});
  float keys = 0;
  for (const HelpRow& row : rows) keys = std::max(keys, ImGui::CalcTextSize(row.keys.c_str()).x);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x / 2, size.y / 2), ImGuiCond_Appearing, ImVec2(0.5F, 0.5F));
  ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(0.96F * size.x, 0.92F * size.y));
  const std::string title = std::string(tell(state, Text::panel_keys)) + "###keys";
  ImGui::Begin(title.c_str(), &state.help,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushTextWrapPos(0.9F * size.x);
  for (const HelpRow& row : rows) {
    ImGui::TextUnformatted(row.keys.c_str());
    ImGui::SameLine(keys + 2 * ImGui::GetFontSize());
    ImGui::TextUnformatted(row.what);
  }
  ImGui::TextUnformatted(tell(state, Text::help_joint));
  ImGui::TextUnformatted(tell(state, Text::help_pad));
  if (in.gamepad != nullptr)
    ImGui::TextUnformatted(fill(tell(state, Text::gamepad), {in.gamepad}).c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
}

}  // namespace artus
