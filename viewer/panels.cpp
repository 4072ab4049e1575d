// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/viewer/panels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <imgui.h>

#include "artus/core/units.h"
#include "artus/echo/setting_ranges.h"

namespace artus {
namespace {

constexpr ImU32 kWhite = IM_COL32(235, 235, 235, 255);
constexpr ImU32 kYellow = IM_COL32(255, 215, 80, 255);

ImTextureID to_id(unsigned texture) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL's numbers are what Dear ImGui takes here.
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));
}

void draw_ruler(ImDrawList* list, const ImVec2& at, float pixels_per_mm, double depth_mm) {
  const float unit = ImGui::GetFontSize() / 13;  // what is a pixel on a window of 720 lines
  for (int mm = 0; mm <= static_cast<int>(depth_mm); mm += 5) {
    const float y = at.y + pixels_per_mm * static_cast<float>(mm);
    const bool ten = mm % 10 == 0;
    list->AddLine(ImVec2(at.x - unit * (ten ? 8.F : 4.F), y), ImVec2(at.x, y), kWhite, unit);
    if (!ten) continue;
    const std::string text = std::to_string(mm);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    list->AddText(ImVec2(at.x - 11 * unit - size.x, y - size.y / 2), kWhite, text.c_str());
  }
}

void draw_calipers(ImDrawList* list, const ImVec2& at, float pixels_per_mm,
                   const std::vector<ImagePoint>& points) {
  const auto screen = [&](const ImagePoint& p) {
    return ImVec2(at.x + pixels_per_mm * static_cast<float>(p.x_mm),
                  at.y + pixels_per_mm * static_cast<float>(p.y_mm));
  };
  const float unit = ImGui::GetFontSize() / 13;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImVec2 p = screen(points[i]);
    list->AddLine(ImVec2(p.x - 5 * unit, p.y), ImVec2(p.x + 5 * unit, p.y), kYellow, unit);
    list->AddLine(ImVec2(p.x, p.y - 5 * unit), ImVec2(p.x, p.y + 5 * unit), kYellow, unit);
    if (i % 2 == 0) continue;
    const ImVec2 q = screen(points[i - 1]);
    list->AddLine(q, p, kYellow, unit);
    std::array<char, 32> text{};
    std::snprintf(
        text.data(), text.size(), "%.1f mm",
        std::hypot(points[i].x_mm - points[i - 1].x_mm, points[i].y_mm - points[i - 1].y_mm));
    list->AddText(ImVec2(p.x + 7 * unit, p.y - 7 * unit), kYellow, text.data());
  }
}

const std::string& layer_of(const PanelInput& in, std::uint32_t region) {
  const auto& regions = in.session->scene().joint().regions;
  return regions[std::min<std::size_t>(region, regions.size() - 1)].name;
}

}  // namespace

void place_panel(float x, float y, float width, float height) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(x * size.x, y * size.y), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(width * size.x, height * size.y), ImGuiCond_FirstUseEver);
}

std::string describe_status(std::uint32_t status) {
  struct Bit {
    std::uint32_t bit;
    const char* text;
  };
  constexpr std::array<Bit, 14> kBits{{{SessionStatus::kPeerLost, "device lost: no force"},
                                       {SessionStatus::kPeerInvalid, "device sends no valid pose"},
                                       {SessionStatus::kPaused, "paused"},
                                       {SessionStatus::kNoNeedle, "no needle"},
                                       {TickStatus::kNotFinite, "pose not finite"},
                                       {TickStatus::kNotRigid, "pose not rigid"},
                                       {TickStatus::kTeleport, "needle jumped"},
                                       {TickStatus::kTimeReversed, "time ran backwards"},
                                       {TickStatus::kStale, "pose is stale"},
                                       {TickStatus::kOutOfWorkspace, "out of the workspace"},
                                       {TickStatus::kLawNotFinite, "force not finite"},
                                       {TickStatus::kRamping, "force ramps up"},
                                       {TickStatus::kSlewLimited, "change limited"},
                                       {TickStatus::kSaturated, "at the device's limit"}}};
  std::string text;
  for (const Bit& bit : kBits) {
    if ((status & bit.bit) == 0) continue;
    if (!text.empty()) text += ", ";
    text += bit.text;
  }
  return text.empty() ? "all well" : text;
}

void draw_joint_panel(const PanelInput& in, ViewState& state, JointArea& area) {
  place_panel(0.0F, 0.0F, 0.42F, 0.60F);
  ImGui::Begin("Joint");
  const ImVec2 room = ImGui::GetContentRegionAvail();
  area.width = std::max(64, static_cast<int>(room.x));
  area.height = std::max(64, static_cast<int>(room.y));
  ImGui::Image(to_id(in.joint_texture), room, ImVec2(0, 1), ImVec2(1, 0));
  area.hovered = ImGui::IsItemHovered();
  const ImVec2 at = ImGui::GetItemRectMin();
  const bool exploring = in.now.phase == GesturePhase::exploring;
  const char* held = in.grab == Grab::needle ? "needle in hand: wheel pushes, Esc lets go"
                     : in.grab == Grab::probe
                         ? (exploring ? "probe in hand: C chooses the entry, Esc lets go"
                                      : "probe in hand: Esc lets go")
                     : !in.has_hand ? "drag to turn, wheel to come nearer"
                     : exploring    ? "P takes the probe, C chooses the entry, N takes the needle"
                                    : "N takes the needle, X goes back to exploring";
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddText(ImVec2(at.x + 6, at.y + 4), kWhite, held);
  if (!state.message.empty())
    list->AddText(ImVec2(at.x + 6, at.y + room.y - 1.5F * ImGui::GetFontSize()), kYellow,
                  state.message.c_str());
  ImGui::End();
}

void draw_image_panel(const PanelInput& in, ViewState& state) {
  if (state.expert)
    place_panel(0.0F, 0.0F, 0.50F, 1.0F);
  else
    place_panel(0.42F, 0.0F, 0.36F, 0.60F);
  ImGui::Begin(state.expert ? "B-mode##expert" : "B-mode");
  if (in.image == nullptr || in.image->width == 0) {
    ImGui::TextUnformatted("no image yet");
    ImGui::End();
    return;
  }
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float margin = 3 * ImGui::GetFontSize();
  const double width_mm = in.image->width * in.image->pixel / kMillimetre;
  const double depth_mm = in.image->height * in.image->pixel / kMillimetre;
  const double line = ImGui::GetFrameHeightWithSpacing();
  const double fit = std::min((room.x - margin) / width_mm, (room.y - line) / depth_mm);
  const auto scale =
      static_cast<float>(state.true_scale ? state.pixels_per_mm : std::max(fit, 0.5));
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  const ImVec2 at(origin.x + margin, origin.y);
  const ImVec2 size(scale * static_cast<float>(width_mm), scale * static_cast<float>(depth_mm));
  state.image_place = {at.x, at.y, scale};
  ImGui::SetCursorScreenPos(at);
  ImGui::Image(to_id(in.image_texture), size);
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(0) && in.grab == Grab::nothing) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (state.calipers.size() >= 4) state.calipers.clear();
    state.calipers.push_back(state.image_place.point_at(mouse.x, mouse.y));
  }
  draw_ruler(list, at, scale, depth_mm);
  draw_calipers(list, at, scale, state.calipers);
  const float focus =
      at.y + scale * static_cast<float>(state.controls.elevation_focus / kMillimetre);
  const float right = at.x + size.x;
  const float unit = ImGui::GetFontSize() / 13;
  list->AddTriangleFilled(ImVec2(right, focus), ImVec2(right + 8 * unit, focus - 5 * unit),
                          ImVec2(right + 8 * unit, focus + 5 * unit), kYellow);
  list->AddCircleFilled(ImVec2(at.x + 6 * unit, at.y + 6 * unit), 3.5F * unit,
                        kYellow);  // the probe's marked side
  if (in.session->frozen()) list->AddText(ImVec2(at.x + size.x / 2, at.y + 4), kYellow, "frozen");
  ImGui::Text("%.0f x %.0f mm   %.0f MHz   gain %+.0f dB   %.0f dB   image %llu", width_mm,
              depth_mm, state.controls.frequency * 1e-6, state.controls.gain_db,
              state.controls.dynamic_range_db,
              static_cast<unsigned long long>(in.image->input.number));
  ImGui::End();
}

void draw_scanner_panel(const PanelInput& in, ViewState& state) {
  place_panel(0.78F, 0.0F, 0.22F, 0.34F);
  ImGui::Begin("Scanner");
  ImGui::PushItemWidth(0.5F * ImGui::GetContentRegionAvail().x);
  const auto slider = [](const char* label, double& value, const Range& range, double unit,
                         const char* format) {
    auto shown = static_cast<float>(value / unit);
    if (ImGui::SliderFloat(label, &shown, static_cast<float>(range.low / unit),
                           static_cast<float>(range.high / unit), format))
      value = unit * shown;
  };
  ImageControls& c = state.controls;
  slider("depth", c.depth, KnobRanges::depth, kMillimetre, "%.0f mm");
  slider("gain", c.gain_db, KnobRanges::gain_db, 1, "%.0f dB");
  slider("TGC", c.tgc_db_cm_mhz, KnobRanges::tgc_db_cm_mhz, 1, "%.2f dB/cm/MHz");
  slider("range", c.dynamic_range_db, KnobRanges::dynamic_range_db, 1, "%.0f dB");
  slider("frequency", c.frequency, KnobRanges::frequency, 1e6, "%.0f MHz");
  slider("focus", c.elevation_focus, KnobRanges::elevation_focus, kMillimetre, "%.0f mm");
  ImGui::PopItemWidth();
  if (ImGui::Button(in.session->frozen() ? "go on (F)" : "freeze (F)"))
    in.session->set_frozen(!in.session->frozen());
  ImGui::SameLine();
  if (ImGui::Button("save (V)")) state.wants_screenshot = true;
  ImGui::SameLine();
  if (ImGui::Button(state.wants_clip ? "end clip (K)" : "clip (K)"))
    state.wants_clip = !state.wants_clip;
  ImGui::Checkbox("true scale (T)", &state.true_scale);
  ImGui::SameLine();
  if (ImGui::Button("no calipers (M)")) state.calipers.clear();
  ImGui::End();
}

void draw_session_panel(const PanelInput& in, ViewState& state) {
  place_panel(0.78F, 0.34F, 0.22F, 0.30F);
  ImGui::Begin("Session");
  const HapticSnapshot& now = in.now;
  const bool alive = now.input.device.state == PeerState::alive;
  ImGui::TextColored(alive ? ImVec4(0.5F, 0.9F, 0.5F, 1) : ImVec4(1, 0.35F, 0.3F, 1), "%s: %s",
                     std::string(in.session->device_name()).c_str(),
                     to_string(now.input.device.state));
  const bool well = (now.status & (TickStatus::kFaults | 0xffff0000U)) == 0;
  ImGui::PushStyleColor(ImGuiCol_Text,
                        well ? ImVec4(0.8F, 0.8F, 0.8F, 1) : ImVec4(1, 0.6F, 0.3F, 1));
  ImGui::TextWrapped("%s", describe_status(now.status).c_str());
  ImGui::PopStyleColor();
  const Vec3 force(now.force_J[0], now.force_J[1], now.force_J[2]);
  const Vec3 torque(now.torque_J[0], now.torque_J[1], now.torque_J[2]);
  ImGui::Text("%s  %s", layer_of(in, now.feedback.region).c_str(),
              to_string(static_cast<ContactState>(now.feedback.contact)));
  ImGui::Text("depth %.2f mm   %.2f N   %.0f mN m", now.feedback.depth / kMillimetre, force.norm(),
              1e3 * torque.norm());
  ImGui::Text("turn within %.0f deg   %s", now.cone / kDegree, to_string(now.phase));
  if (ImGui::Button(in.session->paused() ? "go on" : "pause"))
    in.session->set_paused(!in.session->paused());
  ImGui::SameLine();
  if (ImGui::Button("reset (R)")) in.session->reset();
  ImGui::SameLine();
  ImGui::Checkbox("expert", &state.expert);
  ImGui::SameLine();
  if (ImGui::Button("?")) state.help = !state.help;
  for (const std::string& refused : in.session->refusals())
    ImGui::TextWrapped("refused: %s", refused.c_str());
  const std::vector<std::string> notices = in.session->notices();
  constexpr std::size_t kShown = 3;
  for (std::size_t i = notices.size() - std::min(kShown, notices.size()); i < notices.size(); ++i)
    ImGui::TextWrapped("%s", notices[i].c_str());
  ImGui::End();
}

void draw_tissue_panel(const PanelInput& in, ViewState& state, JointView& view) {
  if (state.expert) return;
  place_panel(0.78F, 0.64F, 0.22F, 0.36F);
  ImGui::Begin("Tissues");
  ImGui::Checkbox("cut away at the image plane", &view.cut_away);
  for (TissueLook& look : view.looks()) {
    ImGui::PushID(look.name.c_str());
    ImGui::Checkbox("##visible", &look.visible);
    ImGui::SameLine();
    ImGui::ColorButton("##colour", ImVec4(look.colour.x(), look.colour.y(), look.colour.z(), 1), 0,
                       ImVec2(ImGui::GetFontSize(), ImGui::GetFontSize()));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(6 * in.scale * 15);
    ImGui::SliderFloat("##alpha", &look.alpha, 0, 1, "%.2f");
    ImGui::SameLine();
    ImGui::TextUnformatted(look.name.c_str());
    ImGui::PopID();
  }
  ImGui::End();
}

void draw_help(const PanelInput& in, ViewState& state) {
  if (!state.help) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x / 2, size.y / 2), ImGuiCond_Appearing, ImVec2(0.5F, 0.5F));
  ImGui::Begin("Keys", &state.help, ImGuiWindowFlags_AlwaysAutoResize);
  constexpr std::array<std::array<const char*, 2>, 17> kKeys{{
      {"P", "take the probe: mouse slides it, wheel turns it"},
      {"C", "choose the entry point beside the probe: the joint comes to the needle"},
      {"X", "back to exploring"},
      {"N", "take the needle: mouse turns it about the entry, wheel or W S push and pull"},
      {"shift", "with mouse or wheel: a tenth as far"},
      {"Esc", "let go"},
      {"Home", "needle and probe back to the start"},
      {"F", "freeze the image"},
      {"V", "save the image as PNG"},
      {"K", "begin and end a clip"},
      {"T", "image at true scale"},
      {"M", "remove the calipers; two clicks in the image measure"},
      {"SPACE", "pause"},
      {"R", "reset the insertion"},
      {"E", "expert mode: no 3D view"},
      {"gamepad",
       "left stick probe, right stick needle, triggers push and pull; A C, B X, X F, Y R"},
      {"joint", "drag turns it, wheel comes nearer"},
  }};
  for (const auto& [key, what] : kKeys) {
    ImGui::TextUnformatted(key);
    ImGui::SameLine(6 * ImGui::GetFontSize());
    ImGui::TextUnformatted(what);
  }
  if (in.gamepad != nullptr) ImGui::Text("gamepad: %s", in.gamepad);
  ImGui::End();
}

}  // namespace artus
