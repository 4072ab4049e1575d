// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/panels/shade.h"
#include "artus/detail/viewer/words/anatomy_names.h"
#include "artus/detail/viewer/words/system_words.h"

namespace artus {
namespace {

constexpr Shade kWell{0.5F, 0.9F, 0.5F};
constexpr Shade kIll{1, 0.45F, 0.35F};
constexpr Shade kPlain{0.85F, 0.85F, 0.85F};

void wrapped(const std::string& said, const ImVec4& colour = kPlain) {
  wrapped_text(said, colour);
}

/// The gauge of a catalogue's needle; "?" for any other.
std::string gauge_of(const NeedleShape& shape) {
  for (const int gauge : {18, 19, 20, 21, 22, 23, 25, 27}) {
    const auto known = needle_of_gauge(gauge);
    if (known && std::abs(known->outer_diameter - shape.outer_diameter) < 1e-6)
      return std::to_string(gauge);
  }
  return "?";
}

/// What the needle meets; a state that is no longer true is marked so.
void draw_needle_state(const PanelInput& in, const ViewState& state) {
  const Language language = state.language;
  if (in.peer != PeerState::alive && in.now.input.tick != 0)
    wrapped(fill(translate(state, "last state, {} s ago; now: {}"),
                 {number(language, in.lost_for, 0), describe_status(language, in.status)}),
            kIll);
  if (in.now.input.tick == 0) return;
  const Vec3 force(in.now.force_J[0], in.now.force_J[1], in.now.force_J[2]);
  const Vec3 torque(in.now.torque_J[0], in.now.torque_J[1], in.now.torque_J[2]);
  wrapped(fill(translate(state, "depth {} mm   {} N   {} mN m"),
               {number(language, in.needle.depth / kMillimetre, 1),
                number(language, force.norm(), 2), number(language, 1e3 * torque.norm(), 0)}));
  if (in.needle.on_bone && in.needle.hand_excess > 0)
    wrapped(fill(translate(state, "the hand is {} mm ahead of the needle: {} N"),
                 {number(language, in.needle.hand_excess / kMillimetre, 1),
                  number(language, force.norm(), 2)}),
            kIll);
  if (in.needle.hub_on_skin) wrapped(translate(state, "hub on the skin"), kIll);
  if (!state.aids || state.expert) return;
  wrapped(fill(translate(state, "tip in: {}"), {in.needle.layer}));
  if (!in.goal.empty() && in.needle.to_target > 0)
    wrapped(fill(translate(state, "tip to target {} mm"),
                 {number(language, in.needle.to_target / kMillimetre, 1)}));
}

/// Whose hand it is, and whether it is there.
std::string device_line(const PanelInput& in, const ViewState& state) {
  constexpr std::array<const char*, 4> kPeers{msgid("absent"), msgid("connected"), msgid("lost"),
                                              msgid("invalid")};
  static_assert(static_cast<int>(PeerState::absent) == 0 &&
                static_cast<int>(PeerState::invalid) == 3);
  const std::string name = said_by_system(state.language, std::string(in.session->device_name()));
  return fill(translate(state, "{}: {}"),
              {name, translate(state, kPeers.at(static_cast<std::size_t>(in.peer)))});
}

}  // namespace

void draw_session_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::session, msgid("Session"), state);
  if (!scope) return;
  const bool alive = in.peer == PeerState::alive;
  wrapped(device_line(in, state), alive ? kWell : kIll);
  const bool well = (in.status & (TickStatus::kFaults | 0xffff0000U)) == 0;
  if (alive) wrapped(describe_status(state.language, in.status), well ? kPlain : kIll);
  draw_needle_state(in, state);
  const std::string probe = describe_probe(state.language, in.probe);
  if (!probe.empty()) wrapped(probe, in.probe.status == 0 ? kPlain : kIll);
  draw_syringe(in, state);
  draw_patient_words(in, state);
  const SessionParams& params = in.session->params();
  wrapped(fill(translate(state, "needle {} G, {} mm"),
               {gauge_of(params.needle_shape),
                number(state.language, needle_length_of(params) / kMillimetre, 0)}));
  action_button(state, in.session->paused() ? msgid("continue") : msgid("pause"), Action::pause);
  ImGui::SameLine();
  action_button(state, msgid("reset"), Action::reset);
  ImGui::Checkbox(translate(state, "expert"), &state.expert);
  ImGui::SameLine();
  ImGui::Checkbox(translate(state, "aids"), &state.aids);
  ImGui::SameLine();
  ImGui::Checkbox(translate(state, "names"), &state.labels);
  ImGui::Checkbox(translate(state, "left-handed"), &state.left_handed);
  ImGui::SameLine();
  if (ImGui::SmallButton("?")) state.help = !state.help;
  const LatencyHistogram& images = in.session->times().image_interval;
  const double rate = images.count() > 0 ? 1e6 / std::max(images.percentile_us(0.5), 1.0) : 0;
  wrapped(fill(translate(state, "images {} Hz, window {} Hz"),
               {number(state.language, rate, 0), number(state.language, in.window_rate, 0)}));
  for (const std::string& refused : in.session->refusals())
    wrapped(fill(translate(state, "refused: {}"), {said_by_system(state.language, refused)}));
  const std::vector<std::string> notices = in.session->notices();
  constexpr std::size_t kShown = 3;
  for (std::size_t i = notices.size() - std::min(kShown, notices.size()); i < notices.size(); ++i)
    wrapped(said_by_system(state.language, notices[i]));
}

void draw_tissue_panel(const PanelInput& in, ViewState& state, JointView& view) {
  const PanelScope scope(Panel::tissues, msgid("Tissues"), state);
  if (!scope) return;
  ImGui::Checkbox(translate(state, "cut away at the image plane"), &view.cut_away);
  for (TissueLook& look : view.looks()) {
    ImGui::PushID(look.name.c_str());
    ImGui::Checkbox("##visible", &look.visible);
    ImGui::SameLine();
    ImGui::ColorButton("##colour", ImVec4(look.colour.x(), look.colour.y(), look.colour.z(), 1), 0,
                       ImVec2(ImGui::GetFontSize(), ImGui::GetFontSize()));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(5 * in.scale * 13);
    ImGui::SliderFloat("##alpha", &look.alpha, 0, 1, number(state.language, look.alpha, 2).c_str());
    ImGui::SameLine();
    ImGui::TextUnformatted(clinical_name(state.language, look.name).c_str());
    ImGui::PopID();
  }
}

namespace {

std::string what_is_in_hand(const PanelInput& in, const ViewState& state) {
  const auto key = [&state](Action action) {
    return state.keys.said_key(action, state.language);
  };
  if (in.grab == Grab::nothing) return {};
  const char* const held =
      in.grab == Grab::needle
          ? msgid("needle in hand: wheel or {} {} push and pull, mouse turns, {} lets go")
      : in.grab == Grab::plunger
          ? msgid("thumb on the plunger: wheel or {} {} press and draw back, {} lets go")
          : msgid(
                "probe in hand: mouse slides, ctrl tilts, wheel turns, {} {} press and lift, {} "
                "lets go");
  return fill(translate(state, held), {key(Action::push), key(Action::pull), key(Action::let_go)});
}

/// The bone that the needle's tip feels through the skin, or that the pointer is over.
std::string felt_bone(const PanelInput& in, const JointView& view,
                      const std::vector<ScreenLabel>& marks, const ImVec2& at, float reach) {
  if (in.now.input.tick != 0 && in.now.input.device.has_needle != 0 && in.now.inserted == 0)
    if (std::string felt = view.felt_at(to_pose(in.now.X_JN).translation()); !felt.empty())
      return felt;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  std::string felt;
  for (const ScreenLabel& mark : marks) {
    const float distance = std::hypot(mouse.x - at.x - mark.x, mouse.y - at.y - mark.y);
    if (distance > reach) continue;
    reach = distance;
    felt = mark.name;
  }
  return felt;
}

/// The bones that can be felt, the sides, and where on the person one is.
void draw_person(const PanelInput& in, const ViewState& state, JointView& view, const ImVec2& at,
                 const ImVec2& room) {
  const unsigned person = view.overview();
  if (person == 0) return;
  ImDrawList* list = ImGui::GetWindowDrawList();
  const auto width = static_cast<int>(room.x);
  const auto height = static_cast<int>(room.y);
  const std::vector<ScreenLabel> marks = view.landmarks(width, height);
  const std::string felt = felt_bone(in, view, marks, at, 12 * in.scale);
  for (const ScreenLabel& mark : marks) {
    const ImVec2 place(at.x + mark.x, at.y + mark.y);
    list->AddCircleFilled(place, 3 * in.scale, to_imgui(kOutline));
    list->AddCircleFilled(place, 2 * in.scale, to_imgui(kOverlay));
    if (mark.name == felt)
      outlined_text(list, ImVec2(place.x + 6 * in.scale, place.y - 8 * in.scale),
                    clinical_name(state.language, felt));
  }
  for (const ScreenLabel& side : view.sides(width, height))
    outlined_text(list, ImVec2(at.x + side.x, at.y + side.y),
                  side.name == "R" ? translate_in(state.language, "side", "R")
                                   : translate_in(state.language, "side", "L"));
  const float tall = 0.36F * room.y;
  const float wide = tall * JointView::kOverviewWidth / JointView::kOverviewHeight;
  if (wide > 0.4F * room.x) return;
  const ImVec2 corner(at.x + room.x - wide - 2, at.y + 2);
  const ImVec2 end(corner.x + wide, corner.y + tall);
  list->AddImage(to_imgui(person), corner, end, ImVec2(0, 1), ImVec2(1, 0));
  list->AddRect(corner, end, to_imgui(kOutline));
}

}  // namespace

void draw_joint_panel(const PanelInput& in, ViewState& state, JointView& view, JointArea& area) {
  if (state.expert) return;
  const PanelScope scope(Panel::joint, msgid("Joint"), state,
                         ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  if (!scope) return;
  const ImVec2 room = ImGui::GetContentRegionAvail();
  area.width = std::max(64, static_cast<int>(room.x));
  area.height = std::max(64, static_cast<int>(room.y));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (in.joint_texture != 0)
    ImGui::Image(to_imgui(in.joint_texture), room, ImVec2(0, 1), ImVec2(1, 0));
  else
    ImGui::TextUnformatted(translate(state, "The joint is being drawn ..."));
  ImGui::SetCursorScreenPos(at);
  ImGui::InvisibleButton("joint", ImVec2(std::max(room.x, 1.F), std::max(room.y, 1.F)));
  const ImGuiIO& io = ImGui::GetIO();
  OrbitCamera& camera = view.camera();
  if (ImGui::IsItemActive() && in.grab == Grab::nothing) {
    camera.yaw += 0.01 * static_cast<double>(io.MouseDelta.x);
    camera.pitch =
        std::clamp(camera.pitch + 0.01 * static_cast<double>(io.MouseDelta.y), -1.5, 1.5);
  }
  if (ImGui::IsItemHovered() && in.grab == Grab::nothing && io.MouseWheel != 0)
    camera.distance = std::clamp(camera.distance * std::pow(0.9, io.MouseWheel),
                                 OrbitCamera::kNearest, OrbitCamera::kFarthest);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect(at, ImVec2(at.x + room.x, at.y + room.y), true);
  if (state.labels) {
    std::vector<NamedPoint> names;
    for (const ScreenLabel& label : view.labels(area.width, area.height))
      names.push_back({clinical_name(state.language, label.name), label.x, label.y});
    draw_names(list, at, room, names);
  }
  draw_person(in, state, view, at, room);
  const std::string said = what_is_in_hand(in, state);
  if (!said.empty()) {
    ImGui::PushTextWrapPos(0);
    const ImVec2 size = ImGui::CalcTextSize(said.c_str(), nullptr, false, room.x - 8);
    const ImVec2 corner(at.x + 4, at.y + room.y - size.y - 4);
    list->AddRectFilled(ImVec2(corner.x - 2, corner.y - 2),
                        ImVec2(corner.x + size.x + 2, corner.y + size.y + 2),
                        IM_COL32(0, 0, 0, 225));
    list->AddText(nullptr, 0, corner, to_imgui(kOverlay), said.c_str(), nullptr, room.x - 8);
    ImGui::PopTextWrapPos();
  }
  list->PopClipRect();
}

}  // namespace artus
