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
  constexpr std::array<std::pair<Panel, const char*>, 6> kChoices{
      {{Panel::joint, msgid("Joint")},
       {Panel::scanner, msgid("Scanner")},
       {Panel::session, msgid("Session")},
       {Panel::tissues, msgid("Tissues")},
       {Panel::force, msgid("Force")},
       {Panel::rates, msgid("Rates")}}};
  const float right = ImGui::GetWindowContentRegionMax().x;
  for (const auto& [panel, name] : kChoices) {
    if (state.expert && (panel == Panel::joint || panel == Panel::tissues)) continue;
    const float width =
        ImGui::CalcTextSize(translate(state, name)).x + 2 * ImGui::GetStyle().FramePadding.x;
    if (ImGui::GetCursorPosX() + width > right && ImGui::GetCursorPosX() > width) ImGui::NewLine();
    const bool chosen = state.layout.chosen() == panel;
    if (chosen)
      ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (ImGui::SmallButton(translate(state, name))) state.layout.choose(panel);
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
    ImGui::TextColored(ImVec4(1, 0.3F, 0.3F, 1), "\xe2\x97\x8f %s %s s", translate(state, "REC"),
                       number(state.language, in.clip_seconds, 1).c_str());
  if (!state.message.empty()) wrapped_text(state.message, kGood);
  ImGui::PopTextWrapPos();
}

}  // namespace

void draw_guide_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::guide, msgid("Guide"), state,
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
  ImGui::TextUnformatted(translate(state, "What would you like to do?"));
  action_button(state, msgid("Explore with the probe"), Action::take_probe);
  const auto& injections = in.session->scene().joint().injections;
  for (std::size_t i = 0; in.has_hand && i < injections.size(); ++i) {
    const std::string name =
        fill(translate(state, "Inject {}: {}"),
             {std::to_string(i + 1), clinical_name(state.language, injections[i].name)});
    if (ImGui::Button(name.c_str())) state.planned = i;
    if (i % 2 == 0 && i + 1 < injections.size() && !state.layout.narrow()) ImGui::SameLine();
  }
  if (state.offers_training &&
      ImGui::Button(translate(state, "Train: tasks with a verdict, a review and a record")))
    state.quit = state.training = true;
  action_button(state, msgid("Help: all keys"), Action::help);
  ImGui::End();
  ImGui::PopStyleColor();
}

void draw_help(const PanelInput& in, ViewState& state) {
  if (!state.help) return;
  std::vector<HelpRow> rows = help_rows(state.keys, state.language);
  rows.push_back(
      {translate(state, "ctrl"),
       translate(state, "ctrl with the probe in hand: mouse rocks and fans, wheel presses")});
  rows.push_back({translate(state, "shift"),
                  translate(state, "with mouse, wheel or arrows: ten times finer")});
  float keys = 0;
  for (const HelpRow& row : rows) keys = std::max(keys, ImGui::CalcTextSize(row.keys.c_str()).x);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x / 2, size.y / 2), ImGuiCond_Appearing, ImVec2(0.5F, 0.5F));
  ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(0.96F * size.x, 0.92F * size.y));
  const std::string title = std::string(translate(state, "Keys")) + "###keys";
  ImGui::Begin(title.c_str(), &state.help,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushTextWrapPos(0.9F * size.x);
  for (const HelpRow& row : rows) {
    ImGui::TextUnformatted(row.keys.c_str());
    ImGui::SameLine(keys + 2 * ImGui::GetFontSize());
    ImGui::TextUnformatted(row.what);
  }
  ImGui::TextUnformatted(translate(state, "drag turns the joint, wheel zooms"));
  ImGui::TextUnformatted(
      translate(state,
                "left stick probe, right stick needle, triggers push and pull; right bumper: the "
                "triggers press the plunger; A entry, B back, X freeze, Y reset"));
  if (in.gamepad != nullptr)
    ImGui::TextUnformatted(fill(translate(state, "gamepad: {}"), {in.gamepad}).c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
}

}  // namespace artus
