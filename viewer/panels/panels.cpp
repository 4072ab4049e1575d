// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/panels.h"

#include <array>
#include <cmath>
#include <map>

#include "artus/detail/viewer/panels/label_places.h"

namespace artus {

PanelScope::PanelScope(Panel panel, const char* title, ViewState& state, int flags) {
  const PanelPlace place = state.layout.place(panel);
  if (place.width <= 0) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const std::string name =
      std::string(translate(state, title)) + "###" + std::string(name_of(panel));
  ImGuiStorage* seen = ImGui::GetStateStorage();  // of the implicit window: versions by panel
  const ImGuiID id = ImGui::GetID(name_of(panel).data());
  const bool fresh = seen->GetInt(id) != state.layout.version();
  if (fresh) {
    seen->SetInt(id, state.layout.version());
    ImGui::SetNextWindowPos(ImVec2(place.x * screen.x, place.y * screen.y));
    ImGui::SetNextWindowSize(ImVec2(place.width * screen.x, place.height * screen.y));
    ImGui::SetNextWindowCollapsed(false);
  }
  if (panel == Panel::guide || state.layout.narrow())
    flags |= ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize;
  shown_ = ImGui::Begin(name.c_str(), nullptr, flags | ImGuiWindowFlags_NoSavedSettings);
  begun_ = true;
  if (fresh || screen.x <= 0 || ImGui::IsWindowCollapsed()) return;
  const ImVec2 at = ImGui::GetWindowPos();
  const ImVec2 size = ImGui::GetWindowSize();
  const PanelPlace now{at.x / screen.x, at.y / screen.y, size.x / screen.x, size.y / screen.y};
  const float off =
      std::max({std::abs(now.x - place.x) * screen.x, std::abs(now.y - place.y) * screen.y,
                std::abs(now.width - place.width) * screen.x,
                std::abs(now.height - place.height) * screen.y});
  if (off > 2 && ImGui::IsMouseDown(0) && panel != Panel::guide) state.layout.move(panel, now);
}

PanelScope::~PanelScope() {
  if (begun_) ImGui::End();
}

ImU32 to_imgui(const Rgb& c, int alpha) noexcept {
  return IM_COL32(c[0], c[1], c[2], alpha);
}

ImTextureID to_imgui(unsigned texture) noexcept {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL's numbers are what Dear ImGui takes here.
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));
}

void outlined_text(ImDrawList* list, const ImVec2& at, const std::string& text) {
  const float d = std::max(1.F, ImGui::GetFontSize() / 13);
  for (const ImVec2& off : {ImVec2(-d, 0), ImVec2(d, 0), ImVec2(0, -d), ImVec2(0, d),
                            ImVec2(-d, -d), ImVec2(d, d), ImVec2(-d, d), ImVec2(d, -d)})
    list->AddText(ImVec2(at.x + off.x, at.y + off.y), to_imgui(kOutline), text.c_str());
  list->AddText(at, to_imgui(kOverlay), text.c_str());
}

void outlined_line(ImDrawList* list, const ImVec2& a, const ImVec2& b) {
  const float d = std::max(1.F, ImGui::GetFontSize() / 13);
  list->AddLine(a, b, to_imgui(kOutline), 3 * d);
  list->AddLine(a, b, to_imgui(kOverlay), d);
}

void draw_names(ImDrawList* list, const ImVec2& corner, const ImVec2& size,
                const std::vector<NamedPoint>& names) {
  std::vector<LabelBox> requested;
  for (const NamedPoint& n : names) {
    const ImVec2 text = ImGui::CalcTextSize(n.name.c_str());
    requested.push_back({n.x - text.x / 2, n.y - text.y / 2, text.x, text.y});
  }
  const auto placed = place_labels(requested, size.x, size.y);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (placed[i])
      outlined_text(list, ImVec2(corner.x + placed[i]->x, corner.y + placed[i]->y), names[i].name);
  }
}

std::string with_key(const ViewState& state, const char* which, Action action) {
  const std::string key = state.keys.said_key(action, state.language);
  std::string shown = translate(state, which);
  if (!key.empty()) shown += " (" + key + ")";
  return shown + "###" + std::string(name_of(action));
}

void action_button(ViewState& state, const char* which, Action action, bool on) {
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
  if (ImGui::Button(with_key(state, which, action).c_str()))
    state.requests.push_back({action, false});
  if (on) ImGui::PopStyleColor();
}

std::string describe_status(Language language, std::uint32_t status) {
  struct Bit {
    std::uint32_t bit;
    const char* text;
  };
  constexpr std::array<Bit, 15> kBits{
      {{SessionStatus::kPeerLost, msgid("device lost: no force")},
       {SessionStatus::kPeerInvalid, msgid("device sends no valid pose")},
       {SessionStatus::kPaused, msgid("paused")},
       {SessionStatus::kNoNeedle, msgid("no needle")},
       {SessionStatus::kTissueLate, msgid("the tissue answers late")},
       {TickStatus::kNotFinite, msgid("pose not finite")},
       {TickStatus::kNotRigid, msgid("pose not rigid")},
       {TickStatus::kTeleport, msgid("needle jumped")},
       {TickStatus::kTimeReversed, msgid("time ran backwards")},
       {TickStatus::kStale, msgid("pose is stale")},
       {TickStatus::kOutOfWorkspace, msgid("out of the workspace")},
       {TickStatus::kLawNotFinite, msgid("force not finite")},
       {TickStatus::kRamping, msgid("force ramps up")},
       {TickStatus::kSlewLimited, msgid("force change limited")},
       {TickStatus::kSaturated, msgid("at the device's limit")}}};
  std::string said;
  for (const Bit& bit : kBits) {
    if ((status & bit.bit) == 0) continue;
    if (!said.empty()) said += ", ";
    said += translate(language, bit.text);
  }
  return said.empty() ? translate(language, "all well") : said;
}

}  // namespace artus
