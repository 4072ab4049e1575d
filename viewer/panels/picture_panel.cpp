// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/panels/caption.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

constexpr ImU32 kWhite = IM_COL32(235, 235, 235, 255);

/// One picture, where it stands and what of it is seen.
struct Sheet {
  ImDrawList* list;
  const ImageSnapshot* image;
  ImagePlace place;
  ImVec2 corner;  // upper left of what is seen
  ImVec2 size;    // of the same, pixels
  double width_mm;
  double depth_mm;
  float unit;  // what is a pixel at letters of 13 pixels
  [[nodiscard]] ImVec2 at(const ImagePoint& p) const {
    return {static_cast<float>(place.x_of(p)), static_cast<float>(place.y_of(p))};
  }
  [[nodiscard]] bool sees_depth(float y) const {
    return y >= corner.y - 0.5F && y <= corner.y + size.y + 0.5F;
  }
  [[nodiscard]] bool sees(const ImVec2& p) const {
    return p.x >= corner.x && p.x <= corner.x + size.x && sees_depth(p.y);
  }
};

/// A picture whose seen part begins at `corner`, `scale` pixels a millimetre before the zoom.
Sheet make_sheet(const ImageSnapshot& image, const ImVec2& corner, double scale,
                 const ViewState& state) {
  const double width_mm = image.width * image.pixel / kMillimetre;
  const double depth_mm = image.height * image.pixel / kMillimetre;
  const ImVec2 size(static_cast<float>(scale * width_mm), static_cast<float>(scale * depth_mm));
  const PictureView& view = state.view;
  const double zoomed = scale * view.zoom;
  const double shift = view.u * zoomed * width_mm;
  const ImagePlace place{state.look.flipped ? corner.x + size.x + shift : corner.x - shift,
                         corner.y - view.v * zoomed * depth_mm, zoomed, state.look.flipped};
  return {ImGui::GetWindowDrawList(), &image, place, corner, size, width_mm, depth_mm,
          ImGui::GetFontSize() / 13};
}

void draw_ruler(const Sheet& sheet) {
  const float left = sheet.corner.x;
  for (int mm = 0; mm <= static_cast<int>(sheet.depth_mm); mm += 5) {
    const auto y = static_cast<float>(sheet.place.y_of({0, static_cast<double>(mm)}));
    if (!sheet.sees_depth(y)) continue;
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

/// Along the face, from the probe's middle to both sides, at the lower edge of what is seen.
void draw_lateral_ruler(const Sheet& sheet) {
  const float bottom = sheet.corner.y + sheet.size.y;
  const double middle = sheet.width_mm / 2;
  const int most = static_cast<int>(middle);
  for (int mm = -(most - most % 5); mm <= most; mm += 5) {
    const auto x = static_cast<float>(sheet.place.x_of({middle + mm, 0}));
    if (x < sheet.corner.x || x > sheet.corner.x + sheet.size.x) continue;
    const bool ten = mm % 10 == 0;
    outlined_line(sheet.list, ImVec2(x, bottom - sheet.unit * (ten ? 8.F : 4.F)),
                  ImVec2(x, bottom));
    if (!ten) continue;
    const std::string text = std::to_string(std::abs(mm));
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    outlined_text(sheet.list, ImVec2(x - size.x / 2, bottom - 9 * sheet.unit - size.y), text);
  }
}

void draw_cross(const Sheet& sheet, const ImVec2& p) {
  const float arm = 5 * sheet.unit;
  outlined_line(sheet.list, ImVec2(p.x - arm, p.y), ImVec2(p.x + arm, p.y));
  outlined_line(sheet.list, ImVec2(p.x, p.y - arm), ImVec2(p.x, p.y + arm));
}

void draw_calipers(const Sheet& sheet, const ViewState& state) {
  const auto found = state.calipers.find(sheet.image->input.number);
  if (found == state.calipers.end()) return;
  const std::vector<ImagePoint>& points = found->second;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImVec2 p = sheet.at(points[i]);
    draw_cross(sheet, p);
    if (i % 2 == 0) continue;
    outlined_line(sheet.list, sheet.at(points[i - 1]), p);
    const std::string said =
        number(state.language, distance_mm(points[i - 1], points[i]), 1) + " mm";
    const float most = sheet.corner.x + sheet.size.x - ImGui::CalcTextSize(said.c_str()).x;
    outlined_text(sheet.list, ImVec2(std::min(p.x + 7 * sheet.unit, most), p.y - 16 * sheet.unit),
                  said);
  }
}

/// The picture itself, as much as is seen of it.
void draw_grey(const Sheet& sheet, unsigned texture, const ViewState& state) {
  const auto share = static_cast<float>(1 / state.view.zoom);
  const auto u = static_cast<float>(state.view.u);
  const auto v = static_cast<float>(state.view.v);
  const float left = state.look.flipped ? u + share : u;
  const float right = state.look.flipped ? u : u + share;
  ImGui::SetCursorScreenPos(sheet.corner);
  ImGui::Image(to_imgui(texture), sheet.size, ImVec2(left, v), ImVec2(right, v + share));
}

/// A drag moves the colour box, or what is seen of a zoomed picture.
void take_drag(const Sheet& sheet, ViewState& state) {
  const ImVec2 distance = ImGui::GetIO().MouseDelta;
  double x = distance.x / (sheet.place.scale * sheet.width_mm);
  const double y = distance.y / (sheet.place.scale * sheet.depth_mm);
  if (sheet.place.flipped) x = -x;
  if (state.drags_box)
    state.look.box.move(x, y);
  else
    state.view.move(-x, -y);
}

/// A click sets a caliper's point.
void take_clicks(const Sheet& sheet, const PanelInput& in, ViewState& state) {
  constexpr float kStill = 4;  // pixels that a click may move
  if (in.grab != Grab::nothing) return;
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 pressed = io.MouseClickedPos[0];
  const float distance = std::hypot(io.MousePos.x - pressed.x, io.MousePos.y - pressed.y);
  const ImagePoint from = sheet.place.point_at(pressed.x, pressed.y);
  if (ImGui::IsItemActivated())
    state.drags_box = state.look.colour && state.look.box.contains(from.x_mm / sheet.width_mm,
                                                                   from.y_mm / sheet.depth_mm);
  if (ImGui::IsItemActive() && distance > kStill * sheet.unit) take_drag(sheet, state);
  if (!ImGui::IsItemHovered() || !ImGui::IsMouseReleased(0) || distance > kStill * sheet.unit)
    return;
  if (!in.session->frozen()) state.requests.push_back({Action::freeze, false});
  state.calipers[in.image->input.number].push_back(from);
}

/// The frame of the colour box, and what its colours mean.
void draw_colour_box(const Sheet& sheet, const PanelInput& in, const ViewState& state) {
  if (!state.look.colour) return;
  const ColourBox& box = state.look.box;
  const auto corner = [&](double side) {
    return sheet.at({(box.x + side * box.width / 2) * sheet.width_mm,
                     (box.y + side * box.height / 2) * sheet.depth_mm});
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
void draw_body_mark(const Sheet& sheet, const PanelInput& in, float right) {
  if (in.mark == nullptr) return;
  const ImVec2 corner(right, sheet.corner.y + sheet.size.y);
  const float beside = right - sheet.corner.x - sheet.size.x;
  const auto size = static_cast<float>(in.mark->size);
  const float scale = sheet.unit * (beside < sheet.unit * size ? 0.5F : 1.F);
  const float side = scale * size;
  const ImVec2 at(corner.x - side, corner.y - side);
  sheet.list->AddImage(to_imgui(in.mark_texture), at, corner);
  const MarkLine line =
      probe_on_mark(*in.mark, to_pose(sheet.image->input.X_JP), sheet.image->probe_width);
  const ImVec2 from(at.x + scale * line.x0, at.y + scale * line.y0);
  outlined_line(sheet.list, from, ImVec2(at.x + scale * line.x1, at.y + scale * line.y1));
  sheet.list->AddCircleFilled(from, 3 * scale, to_imgui(kOverlay));
}

/// Focus, the probe's marked side, whose joint it is, and `state_of_it`.
void draw_marks(const Sheet& sheet, const PanelInput& in, const ViewState& state,
                const std::string& state_of_it) {
  const ImVec2& at = sheet.corner;
  const double focus_mm = sheet.image->input.controls.elevation_focus / kMillimetre;
  const auto focus = static_cast<float>(sheet.place.y_of({0, focus_mm}));
  const float right = at.x + sheet.size.x;
  if (sheet.sees_depth(focus))
    sheet.list->AddTriangleFilled(
        ImVec2(right, focus), ImVec2(right + 8 * sheet.unit, focus - 5 * sheet.unit),
        ImVec2(right + 8 * sheet.unit, focus + 5 * sheet.unit), to_imgui(kOverlay));
  const float x = state.look.flipped ? right - 6 * sheet.unit : at.x + 6 * sheet.unit;
  const ImVec2 mark(x, at.y + 6 * sheet.unit);
  sheet.list->AddCircleFilled(mark, 4.5F * sheet.unit, to_imgui(kOutline));
  sheet.list->AddCircleFilled(mark, 3.5F * sheet.unit, to_imgui(kOverlay));
  outlined_text(sheet.list, ImVec2(at.x + 0.4F * sheet.size.x, at.y + 2), state_of_it);
  std::string who = state.patient;
  const std::string& side = in.session->scene().joint().side;
  if (side == "left" || side == "right")
    who += (who.empty() ? "" : "  ") +
           std::string(translate(state, side == "left" ? msgid("left") : msgid("right")));
  outlined_text(sheet.list, ImVec2(at.x + 16 * sheet.unit, at.y + 2), who);
}

/// From the truth: whether the needle is in the plane, and the structures' names. Both are of now,
/// so that the first is not told of a frozen picture.
void draw_aids(const Sheet& sheet, const PanelInput& in, const ViewState& state) {
  if (state.expert) return;
  const float line = 1.3F * ImGui::GetFontSize();
  const ImVec2& at = sheet.corner;
  const bool live = in.peer == PeerState::alive && !in.session->frozen();
  if (state.aids && live && in.needle.inside) {
    const std::string said =
        in.needle.in_plane ? std::string(translate(state, "needle in plane"))
                           : fill(translate(state, "needle out of plane: {} mm, {} deg"),
                                  {number(state.language, in.needle.plane_offset / kMillimetre, 1),
                                   number(state.language, in.needle.plane_angle / kDegree, 0)});
    outlined_text(sheet.list, ImVec2(at.x + 4, at.y + sheet.size.y - line), said);
  }
  if (!state.labels) return;
  std::vector<NamedPoint> names;  // between the lines above and below
  for (const PictureLabel& label : in.labels) {
    const ImVec2 p = sheet.at({label.x_mm, label.y_mm});
    if (sheet.sees(p)) names.push_back({label.name, p.x - at.x, p.y - at.y - line});
  }
  draw_names(sheet.list, ImVec2(at.x, at.y + line),
             ImVec2(sheet.size.x, std::max(sheet.size.y - 2 * line, 0.F)), names);
}

/// What a task shows of the truth to help; of the shown picture.
void draw_lesson_marks(const Sheet& sheet, const PanelInput& in) {
  for (const PictureMark& mark : in.marks) {
    const ImU32 colour = to_imgui(kOverlay, static_cast<int>(255 * mark.alpha));
    const ImVec2 at = sheet.at(mark.at);
    const float radius = 6 * sheet.unit;
    if (mark.to)
      sheet.list->AddLine(at, sheet.at(*mark.to), colour, 1.5F * sheet.unit);
    else if (mark.full)
      sheet.list->AddCircleFilled(at, radius, colour);
    else
      sheet.list->AddCircle(at, radius, colour, 0, 1.5F * sheet.unit);
  }
}

std::string live_or_frozen(const PanelInput& in, const ViewState& state) {
  if (!in.session->frozen()) return {};
  std::string said = translate(state, "frozen");
  if (in.cine_age > 0) said += "  -" + number(state.language, in.cine_age, 1) + " s";
  return said;
}

/// The pictures stand in columns of equal width, all at one scale.
struct Columns {
  ImVec2 origin;
  float width;   // of each
  float height;  // of a picture
  float margin;  // of the ruler
  double scale;  // pixels a millimetre
  [[nodiscard]] float left(int i) const { return origin.x + static_cast<float>(i) * width; }
  [[nodiscard]] ImVec2 corner(int i) const { return {left(i) + margin, origin.y}; }
};

/// The settings stand below each picture; where they wrap, that is less room for it.
Columns make_columns(const PanelInput& in, const ViewState& state) {
  const float unit = ImGui::GetFontSize() / 13;
  const ImVec2 room = ImGui::GetContentRegionAvail();
  Columns columns{ImGui::GetCursorScreenPos(), in.kept != nullptr ? 0.5F * room.x : room.x, room.y,
                  32 * unit, state.pixels_per_mm};
  double scale = 1e9;
  float below = 0;
  for (const ImageSnapshot* image : {in.image, in.kept}) {
    if (image == nullptr) continue;
    const std::string settings = settings_line(state.language, *image);
    below = std::max(
        below, ImGui::CalcTextSize(settings.c_str(), nullptr, false, columns.width - 8 * unit).y);
    scale = std::min(scale, (columns.width - columns.margin - 10 * unit) * kMillimetre /
                                (image->width * image->pixel));
  }
  columns.height -= below + 0.6F * ImGui::GetFrameHeightWithSpacing();
  for (const ImageSnapshot* image : {in.image, in.kept})
    if (image != nullptr)
      scale = std::min(scale, columns.height * kMillimetre / (image->height * image->pixel));
  if (!state.true_scale) columns.scale = std::max(scale, 0.5);
  return columns;
}

void draw_settings(const Sheet& sheet, const Columns& columns, int column, Language language) {
  const float x = columns.left(column);
  ImGui::SetCursorScreenPos(ImVec2(x, sheet.corner.y + sheet.size.y + 4 * sheet.unit));
  ImGui::PushTextWrapPos(x + columns.width - 8 * sheet.unit - ImGui::GetWindowPos().x);
  ImGui::TextUnformatted(settings_line(language, *sheet.image).c_str());
  ImGui::PopTextWrapPos();
}

/// What every picture has, live or kept.
void draw_sheet(const Sheet& sheet, const PanelInput& in, const ViewState& state,
                const std::string& state_of_it) {
  draw_ruler(sheet);
  draw_lateral_ruler(sheet);
  const ImVec2 end(sheet.corner.x + sheet.size.x + 10 * sheet.unit, sheet.corner.y + sheet.size.y);
  sheet.list->PushClipRect(sheet.corner, end, true);
  draw_marks(sheet, in, state, state_of_it);
  draw_calipers(sheet, state);
  sheet.list->PopClipRect();
}

void draw_kept(const PanelInput& in, const ViewState& state, const Columns& columns) {
  const Sheet sheet = make_sheet(*in.kept, columns.corner(1), columns.scale, state);
  draw_grey(sheet, in.kept_texture, state);
  draw_sheet(sheet, in, state, translate(state, "kept"));
  draw_body_mark(sheet, in, columns.left(2) - 4 * sheet.unit);
  draw_settings(sheet, columns, 1, state.language);
}

void draw_picture(const PanelInput& in, ViewState& state) {
  const Columns columns = make_columns(in, state);
  if (in.kept != nullptr) draw_kept(in, state, columns);
  const Sheet sheet = make_sheet(*in.image, columns.corner(0), columns.scale, state);
  state.image_place = sheet.place;
  draw_grey(sheet, in.image_texture, state);
  ImGui::SetCursorScreenPos(sheet.corner);
  ImGui::InvisibleButton("picture", sheet.size);
  take_clicks(sheet, in, state);
  draw_sheet(sheet, in, state, live_or_frozen(in, state));
  sheet.list->PushClipRect(
      sheet.corner, ImVec2(sheet.corner.x + sheet.size.x, sheet.corner.y + sheet.size.y), true);
  draw_colour_box(sheet, in, state);
  draw_lesson_marks(sheet, in);
  if (state.cross) draw_cross(sheet, sheet.at(*state.cross));
  sheet.list->PopClipRect();
  draw_body_mark(sheet, in, columns.left(1) - (in.kept != nullptr ? 4 * sheet.unit : 0));
  draw_aids(sheet, in, state);
  draw_settings(sheet, columns, 0, state.language);
}

}  // namespace

void draw_image_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::picture, msgid("B-mode"), state,
                         ImGuiWindowFlags_NoScrollWithMouse);
  if (!scope) return;
  if (in.image == nullptr || in.image->width == 0)
    ImGui::TextUnformatted(translate(state, "no image yet"));
  else
    draw_picture(in, state);
}

}  // namespace artus
