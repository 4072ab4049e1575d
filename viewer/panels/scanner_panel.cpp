// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/probe/grey_curve_file.h"
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

/// A list to choose from; the index that was chosen, or `now`.
template <class NameOf>
std::size_t choose(ViewState& state, const char* label, std::size_t now, std::size_t count,
                   const NameOf& name_of) {
  ImGui::SetNextItemWidth(0.5F * ImGui::GetContentRegionAvail().x);
  if (!ImGui::BeginCombo(translate(state, label), now < count ? name_of(now) : "")) return now;
  for (std::size_t i = 0; i < count; ++i)
    if (ImGui::Selectable(name_of(i), i == now)) now = i;
  ImGui::EndCombo();
  return now;
}

/// What the scanner's back end makes of the echoes. None of it stops the picture.
void draw_back_end(ViewState& state) {
  static constexpr std::array kLooks{msgid("raw"), msgid("clinical"), msgid("compound")};
  ImageControls& c = state.controls;
  c.look = static_cast<Look>(choose(state, msgid("look"), static_cast<std::size_t>(c.look),
                                    kLooks.size(),
                                    [&](std::size_t i) { return translate(state, kLooks[i]); }));
  const auto& curves = state.grey_curves;
  const auto same = std::find_if(curves.begin(), curves.end(), [&](const GreyCurvePreset& curve) {
    return curve.curve == c.grey_curve;
  });
  const auto at = static_cast<std::size_t>(same - curves.begin());
  const std::size_t curve = choose(state, msgid("grey curve"), at, curves.size(),
                                   [&](std::size_t i) { return curves[i].name.c_str(); });
  if (curve < curves.size()) c.grey_curve = curves[curve].curve;
  static constexpr std::array kAngles{"1", "3", "5"};
  const std::size_t angles = choose(state, msgid("compounded angles"), c.compound_angles / 2,
                                    kAngles.size(), [&](std::size_t i) { return kAngles[i]; });
  c.compound_angles = static_cast<std::uint32_t>(2 * angles + 1);
  ImGui::PushItemWidth(0.5F * ImGui::GetContentRegionAvail().x);
  draw_knob(state, msgid("persistence"), c.persistence, {KnobRanges::persistence, 0.01, 0, "%"});
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
  draw_back_end(state);
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
  if (state.look.colour) {
    next_in_row(ImGui::CalcTextSize(translate(state, msgid("power"))).x + 40);
    ImGui::Checkbox(translate(state, msgid("power")), &state.look.power);
  }
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
