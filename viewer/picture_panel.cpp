// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "artus/core/units.h"
#include "artus/viewer/anatomy_names.h"
#include "artus/viewer/caption.h"
#include "artus/viewer/panels.h"

namespace artus {
namespace {

constexpr ImU32 kWhite = IM_COL32(235, 235, 235, 255);

/// What is drawn of one picture, and where.
struct Sheet {
  ImDrawList* list;
  ImagePlace place;
  double width_mm;
  double depth_mm;  // that is seen, zoomed
  double full_mm;   // of the picture
  float unit;       // what is a pixel at letters of 13 pixels
  [[nodiscard]] ImVec2 at(const ImagePoint& p) const {
    return {static_cast<float>(place.x_of(p)), static_cast<float>(place.y_of(p))};
  }
};

void draw_ruler(const Sheet& sheet, float left) {
  for (int mm = 0; mm <= static_cast<int>(sheet.depth_mm); mm += 5) {
    const auto y = static_cast<float>(sheet.place.y_of({0, static_cast<double>(mm)}));
    const bool ten = mm % 10 == 0;
    sheet.list->AddLine(ImVec2(left - sheet.unit * (ten ? 8.F : 4.F), y), ImVec2(left, y), kWhite,
                        sheet.unit);
    if (!ten) continue;
    const std::string text = std::to_string(mm);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    sheet.list->AddText(ImVec2(left - 11 * sheet.unit - size.x, y - size.y / 2), kWhite,
                        text.c_str());
  }
}

void draw_cross(const Sheet& sheet, const ImVec2& p) {
  const float arm = 5 * sheet.unit;
  outlined_line(sheet.list, ImVec2(p.x - arm, p.y), ImVec2(p.x + arm, p.y));
  outlined_line(sheet.list, ImVec2(p.x, p.y - arm), ImVec2(p.x, p.y + arm));
}

void draw_calipers(const Sheet& sheet, const ViewState& state, std::uint64_t number_of_image) {
  if (state.cross) draw_cross(sheet, sheet.at(*state.cross));
  const auto found = state.calipers.find(number_of_image);
  if (found == state.calipers.end()) return;
  const std::vector<ImagePoint>& points = found->second;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImVec2 p = sheet.at(points[i]);
    draw_cross(sheet, p);
    if (i % 2 == 0) continue;
    outlined_line(sheet.list, sheet.at(points[i - 1]), p);
    outlined_text(sheet.list, ImVec2(p.x + 7 * sheet.unit, p.y - 16 * sheet.unit),
                  number(state.language, distance_mm(points[i - 1], points[i]), 1) + " mm");
  }
}

/// The picture itself, its middle `zoom` times as large.
void draw_grey(const ImVec2& size, unsigned texture, const ViewState& state) {
  const auto half = static_cast<float>(0.5 / state.zoom);
  const float left = state.look.flipped ? 0.5F + half : 0.5F - half;
  const float right = state.look.flipped ? 0.5F - half : 0.5F + half;
  ImGui::Image(to_imgui(texture), size, ImVec2(left, 0), ImVec2(right, 2 * half));
}

/// A click sets a caliper's point; a drag in the colour box moves it.
void take_clicks(const Sheet& sheet, const PanelInput& in, ViewState& state) {
  constexpr float kStill = 4;  // pixels that a click may move
  if (in.grab != Grab::nothing) return;
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 pressed = io.MouseClickedPos[0];
  const float way = std::hypot(io.MousePos.x - pressed.x, io.MousePos.y - pressed.y);
  const ImagePoint from = sheet.place.point_at(pressed.x, pressed.y);
  if (ImGui::IsItemActivated())
    state.drags_box = state.look.colour && state.look.box.contains(from.x_mm / sheet.width_mm,
                                                                   from.y_mm / sheet.full_mm);
  if (ImGui::IsItemActive() && state.drags_box && way > kStill * sheet.unit) {
    const double x = io.MouseDelta.x / (sheet.place.scale * sheet.width_mm);
    state.look.box.move(sheet.place.flipped ? -x : x,
                        io.MouseDelta.y / (sheet.place.scale * sheet.full_mm));
  }
  if (!ImGui::IsItemHovered() || !ImGui::IsMouseReleased(0) || way > kStill * sheet.unit) return;
  if (!in.session->frozen()) state.wishes.push_back({Action::freeze, false});
  state.calipers[in.image->input.number].push_back(from);
}

/// The frame of the colour box, and what its colours mean.
void draw_colour_box(const Sheet& sheet, const PanelInput& in, const ViewState& state) {
  if (!state.look.colour) return;
  const ColourBox& box = state.look.box;
  const auto corner = [&](double side) {
    return sheet.at({(box.x + side * box.width / 2) * sheet.width_mm,
                     (box.y + side * box.height / 2) * sheet.full_mm});
  };
  const ImVec2 a = corner(-1);
  const ImVec2 b = corner(1);
  const ImVec2 low(std::min(a.x, b.x), a.y);
  const ImVec2 high(std::max(a.x, b.x), b.y);
  sheet.list->AddRect(low, high, to_imgui(kOutline), 0, 0, 3 * sheet.unit);
  sheet.list->AddRect(low, high, to_imgui(kOverlay), 0, 0, sheet.unit);
  const std::string said = doppler_line(state.language, in.session->params().image.doppler_limit);
  outlined_text(sheet.list, ImVec2(low.x + 3, low.y + 1), said);
}

/// The map of the joint with the probe on it, as far to the right as there is room; in the
/// picture's corner, as scanners have it, where there is none beside it: half as large.
void draw_body_mark(const Sheet& sheet, const PanelInput& in, const ImVec2& corner, float beside) {
  if (in.mark == nullptr) return;
  const auto size = static_cast<float>(in.mark->size);
  const float scale = sheet.unit * (beside < sheet.unit * size ? 0.5F : 1.F);
  const float side = scale * size;
  const ImVec2 at(corner.x - side, corner.y - side);
  sheet.list->AddImage(to_imgui(in.mark_texture), at, corner);
  const MarkLine line =
      probe_on_mark(*in.mark, to_pose(in.image->input.X_JP), in.image->probe_width);
  const ImVec2 from(at.x + scale * line.x0, at.y + scale * line.y0);
  outlined_line(sheet.list, from, ImVec2(at.x + scale * line.x1, at.y + scale * line.y1));
  sheet.list->AddCircleFilled(from, 3 * scale, to_imgui(kOverlay));
}

void draw_marks(const Sheet& sheet, const PanelInput& in, const ViewState& state,
                const ImVec2& size) {
  const ImageControls& c = in.image->input.controls;
  const auto at = ImVec2(static_cast<float>(sheet.place.x) - (state.look.flipped ? size.x : 0),
                         static_cast<float>(sheet.place.y));
  const auto focus = static_cast<float>(sheet.place.y_of({0, c.elevation_focus / kMillimetre}));
  const float right = at.x + size.x;
  if (focus < at.y + size.y)
    sheet.list->AddTriangleFilled(
        ImVec2(right, focus), ImVec2(right + 8 * sheet.unit, focus - 5 * sheet.unit),
        ImVec2(right + 8 * sheet.unit, focus + 5 * sheet.unit), to_imgui(kOverlay));
  const float mark = state.look.flipped ? right - 6 * sheet.unit : at.x + 6 * sheet.unit;
  sheet.list->AddCircleFilled(ImVec2(mark, at.y + 6 * sheet.unit), 4.5F * sheet.unit,
                              to_imgui(kOutline));
  sheet.list->AddCircleFilled(ImVec2(mark, at.y + 6 * sheet.unit), 3.5F * sheet.unit,
                              to_imgui(kOverlay));  // the probe's marked side
  const float line = ImGui::GetFontSize();
  if (in.session->frozen()) {
    std::string said = tell(state, Text::frozen);
    if (in.cine_age > 0) said += "  -" + number(state.language, in.cine_age, 1) + " s";
    outlined_text(sheet.list, ImVec2(at.x + 0.4F * size.x, at.y + 2), said);
  }
  std::string who = state.patient;
  const std::string& side = in.session->scene().joint().side;
  if (side == "left" || side == "right")
    who += (who.empty() ? "" : "  ") +
           std::string(tell(state, side == "left" ? Text::side_left : Text::side_right));
  outlined_text(sheet.list, ImVec2(at.x + 16 * sheet.unit, at.y + 2), who);
  const bool aids = state.aids && !state.expert;
  if (aids && in.needle.inside && in.peer == PeerState::alive) {
    const std::string said =
        in.needle.in_plane ? std::string(tell(state, Text::in_plane))
                           : fill(tell(state, Text::out_of_plane),
                                  {number(state.language, in.needle.plane_offset / kMillimetre, 1),
                                   number(state.language, in.needle.plane_angle / kDegree, 0)});
    outlined_text(sheet.list, ImVec2(at.x + 4, at.y + size.y - 1.3F * line), said);
  }
  if (!state.labels || state.expert) return;
  std::vector<NamedPoint> names;
  for (const PictureLabel& label : in.labels) {
    const ImVec2 p = sheet.at({label.x_mm, label.y_mm});
    if (p.y < at.y + size.y - line) names.push_back({label.name, p.x - at.x, p.y - at.y});
  }
  draw_names(sheet.list, at, size, names);
}

/// mm of tissue to pixels, so that the picture fills the room or is as large as it truly is.
double scale_for(const ImVec2& room, const PanelInput& in, const ViewState& state) {
  const double width_mm = in.image->width * in.image->pixel / kMillimetre;
  const double depth_mm = in.image->height * in.image->pixel / kMillimetre;
  if (state.true_scale) return state.pixels_per_mm;
  return std::max(std::min(room.x / width_mm, room.y / depth_mm), 0.5);
}

void draw_kept(const PanelInput& in, const ImVec2& at, const ImVec2& room, const ViewState& state) {
  const double width = in.kept->width * in.kept->pixel;
  const double depth = in.kept->height * in.kept->pixel;
  const double scale = std::min(room.x / width, room.y / depth);
  ImGui::SetCursorScreenPos(at);
  draw_grey(ImVec2(static_cast<float>(scale * width), static_cast<float>(scale * depth)),
            in.kept_texture, state);
}

void draw_picture(const PanelInput& in, ViewState& state) {
  const float unit = ImGui::GetFontSize() / 13;
  const float margin = 32 * unit;
  ImVec2 room = ImGui::GetContentRegionAvail();
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  const float right = origin.x + room.x;
  const std::string settings = settings_line(state.language, *in.image);
  const ImVec2 line = ImGui::CalcTextSize(settings.c_str(), nullptr, false, room.x);
  room.y -= line.y + 0.6F * ImGui::GetFrameHeightWithSpacing();
  if (in.kept != nullptr) {
    room.x = 0.5F * room.x;
    draw_kept(in, ImVec2(origin.x + room.x + 6 * unit, origin.y), ImVec2(room.x - 8 * unit, room.y),
              state);
  }
  const double scale = scale_for(ImVec2(room.x - margin - 10 * unit, room.y), in, state);
  const double width_mm = in.image->width * in.image->pixel / kMillimetre;
  const double depth_mm = in.image->height * in.image->pixel / kMillimetre;
  const ImVec2 at(origin.x + margin, origin.y);
  const ImVec2 size(static_cast<float>(scale * width_mm), static_cast<float>(scale * depth_mm));
  const double zoomed = scale * state.zoom;  // the middle of the picture's upper edge stays
  const double shift = (state.look.flipped ? -0.5 : 0.5) * (zoomed - scale) * width_mm;
  state.image_place = {at.x + (state.look.flipped ? size.x : 0) - shift, at.y, zoomed,
                       state.look.flipped};
  const Sheet sheet{ImGui::GetWindowDrawList(), state.image_place, width_mm,
                    depth_mm / state.zoom,      depth_mm,          unit};
  ImGui::SetCursorScreenPos(at);
  draw_grey(size, in.image_texture, state);
  ImGui::SetCursorScreenPos(at);
  ImGui::InvisibleButton("picture", size);
  take_clicks(sheet, in, state);
  draw_ruler(sheet, at.x);
  sheet.list->PushClipRect(at, ImVec2(at.x + size.x + 10 * unit, at.y + size.y), true);
  draw_marks(sheet, in, state, size);
  draw_colour_box(sheet, in, state);
  draw_calipers(sheet, state, in.image->input.number);
  sheet.list->PopClipRect();
  if (in.kept == nullptr)
    draw_body_mark(sheet, in, ImVec2(right, at.y + size.y), right - at.x - size.x);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(settings.c_str());
  ImGui::PopTextWrapPos();
}

}  // namespace

void draw_image_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::picture, Text::panel_picture, state,
                         ImGuiWindowFlags_NoScrollWithMouse);
  if (!scope) return;
  if (in.image == nullptr || in.image->width == 0)
    ImGui::TextUnformatted(tell(state, Text::no_image));
  else
    draw_picture(in, state);
}

}  // namespace artus
