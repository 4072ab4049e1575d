// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/probe/setting_ranges.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/panels/presets.h"

namespace artus {
namespace {

/// A knob's range, unit and digits.
struct Scale {
  Range range;
  double unit;
  int decimals;
  const char* unit_name;
};

/// The number as the language writes it stands in the format, for Dear ImGui knows points alone.
void draw_knob(const ViewState& state, const char* label, double& value, const Scale& scale) {
  auto shown = static_cast<float>(value / scale.unit);
  const std::string said = number(state.language, shown, scale.decimals) + " " + scale.unit_name;
  if (!ImGui::SliderFloat(translate(state, label), &shown,
                          static_cast<float>(scale.range.low / scale.unit),
                          static_cast<float>(scale.range.high / scale.unit), said.c_str()))
    return;
  const double steps = std::pow(10, scale.decimals);
  value = scale.unit * std::clamp(std::round(steps * shown) / steps, scale.range.low / scale.unit,
                                  scale.range.high / scale.unit);
}

void draw_knobs(ViewState& state) {
  ImGui::PushItemWidth(0.5F * ImGui::GetContentRegionAvail().x);
  ImageControls& c = state.controls;
  draw_knob(state, msgid("depth"), c.depth, {KnobRanges::depth, kMillimetre, 0, "mm"});
  draw_knob(state, msgid("gain"), c.gain_db, {KnobRanges::gain_db, 1, 0, "dB"});
  draw_knob(state, msgid("TGC slope"), c.tgc_db_cm_mhz,
            {KnobRanges::tgc_db_cm_mhz, 1, 2, "dB/cm/MHz"});
  draw_knob(state, msgid("range"), c.dynamic_range_db, {KnobRanges::dynamic_range_db, 1, 0, "dB"});
  draw_knob(state, msgid("frequency"), c.frequency, {KnobRanges::frequency, 1e6, 0, "MHz"});
  draw_knob(state, msgid("focus"), c.elevation_focus,
            {KnobRanges::elevation_focus, kMillimetre, 0, "mm"});
  ImGui::PopItemWidth();
}

void draw_time_gain(ViewState& state) {
  ImGui::TextUnformatted(translate(state, "TGC, dB from shallow to deep"));
  const float gap = 2;
  const float width = ImGui::GetContentRegionAvail().x / 8 - gap;
  for (std::size_t i = 0; i < state.look.tgc_db.size(); ++i) {
    if (i > 0) ImGui::SameLine(0, gap);
    auto db = static_cast<float>(state.look.tgc_db[i]);
    ImGui::PushID(static_cast<int>(i));
    constexpr auto kMax = static_cast<float>(DisplayLook::kMaxDb);
    if (ImGui::VSliderFloat("##tgc", ImVec2(width, 3.2F * ImGui::GetFontSize()), &db, -kMax, kMax,
                            "%.0f"))
      state.look.tgc_db[i] = db;
    ImGui::PopID();
  }
}

void next_in_row(float width) {
  ImGui::SameLine();
  if (ImGui::GetContentRegionAvail().x < width) ImGui::NewLine();
}

void row_button(ViewState& state, const char* which, Action action, bool on = false) {
  const std::string label = with_key(state, which, action);
  const std::string shown = label.substr(0, label.find("###"));
  next_in_row(ImGui::CalcTextSize(shown.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x);
  action_button(state, which, action, on);
}

void draw_cine(const PanelInput& in, ViewState& state) {
  if (!in.session->frozen() || in.cine_size < 2) return;
  auto shown = static_cast<int>(state.cine.value_or(in.cine_size - 1)) + 1;
  const auto last = static_cast<int>(in.cine_size);
  ImGui::SetNextItemWidth(0.7F * ImGui::GetContentRegionAvail().x);
  if (ImGui::SliderInt(translate(state, "cine"), &shown, 1, last))
    state.cine = static_cast<std::size_t>(shown - 1);
}

}  // namespace

void draw_scanner_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::scanner, msgid("Scanner"), state);
  if (!scope) return;
  draw_knobs(state);
  draw_time_gain(state);
  const bool frozen = in.session->frozen();
  action_button(state, frozen ? msgid("continue") : msgid("freeze"), Action::freeze, frozen);
  row_button(state, msgid("save"), Action::save);
  row_button(state, state.wants_clip ? msgid("end clip") : msgid("clip"), Action::clip,
             state.wants_clip);
  draw_cine(in, state);
  for (std::size_t i = 0; i < kPresets.size(); ++i) {
    const char* name = translate(state, kPresets[i].name);
    if (i > 0) next_in_row(ImGui::CalcTextSize(name).x + 2 * ImGui::GetStyle().FramePadding.x);
    if (ImGui::Button(name)) state.controls = with_preset(state.controls, kPresets[i]);
  }
  if (ImGui::Button(translate(state, "default settings"))) {
    state.controls = controls_of(in.session->params());
    state.look = {};
    state.view = {};
  }
  row_button(state, msgid("flip left-right"), Action::flip, state.look.flipped);
  row_button(state, msgid("dual"), Action::dual, state.dual);
  row_button(state, msgid("colour"), Action::doppler, state.look.colour);
  row_button(state, msgid("true scale"), Action::true_scale, state.true_scale);
  row_button(state, msgid("clear calipers"), Action::clear_calipers);
  const std::string zoom = std::string(translate(state, "zoom")) + " " +
                           number(state.language, state.view.zoom, 1) + "###zoom";
  ImGui::TextUnformatted(zoom.substr(0, zoom.find("###")).c_str());
  ImGui::SameLine();
  if (ImGui::SmallButton("-")) state.requests.push_back({Action::zoom_out, false});
  ImGui::SameLine();
  if (ImGui::SmallButton("+")) state.requests.push_back({Action::zoom_in, false});
}

}  // namespace artus
