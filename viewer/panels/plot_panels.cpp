// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/panels/curve.h"
#include "artus/detail/viewer/panels/label_places.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

constexpr ImU32 kAxis = IM_COL32(120, 125, 135, 255);
constexpr ImU32 kGrid = IM_COL32(55, 60, 68, 255);
constexpr ImU32 kText = IM_COL32(205, 205, 205, 255);
constexpr ImU32 kForce = IM_COL32(255, 120, 90, 255);
constexpr ImU32 kLateral = IM_COL32(110, 170, 255, 255);
constexpr ImU32 kProbe = IM_COL32(130, 220, 130, 255);
constexpr ImU32 kLimit = IM_COL32(255, 215, 80, 255);

/// A rectangle of the screen with the values at its edges.
struct Plot {
  ImVec2 from;
  ImVec2 to;
  double x_low = 0;
  double x_high = 1;
  double y_low = 0;
  double y_high = 1;
  [[nodiscard]] ImVec2 at(double x, double y) const {
    const double u = (x - x_low) / (x_high - x_low);
    const double v = (y - y_low) / (y_high - y_low);
    return {from.x + static_cast<float>(std::clamp(u, 0.0, 1.0)) * (to.x - from.x),
            to.y - static_cast<float>(std::clamp(v, 0.0, 1.0)) * (to.y - from.y)};
  }
};

void draw_frame(ImDrawList* list, const Plot& plot, double y_step, Language language) {
  const float font = ImGui::GetFontSize();
  const auto first = static_cast<int>(std::ceil(plot.y_low / y_step));
  const auto last = static_cast<int>(std::floor(plot.y_high / y_step + 1e-9));
  for (int i = first; i <= last; ++i) {
    const double y = i * y_step;
    const ImVec2 p = plot.at(plot.x_low, y);
    list->AddLine(p, ImVec2(plot.to.x, p.y), kGrid);
    const std::string said = number(language, y, 1);
    list->AddText(
        ImVec2(p.x - 0.4F * font - ImGui::CalcTextSize(said.c_str()).x, p.y - 0.5F * font), kText,
        said.c_str());
  }
  list->AddRect(plot.from, plot.to, kAxis);
}

double highest_force(const std::deque<TracePoint>& trace) {
  double most = 3;
  for (const TracePoint& p : trace) most = std::max<double>({most, p.force * 1.1, p.lateral * 1.1});
  return most;
}

double highest_press(const std::deque<TracePoint>& trace) {
  double most = 0;
  for (const TracePoint& p : trace) most = std::max<double>(most, p.probe * 1.1);
  return most;
}

double lowest_force(const std::deque<TracePoint>& trace) {
  double least = -1;
  for (const TracePoint& p : trace) least = std::min<double>(least, p.force * 1.1);
  return least;
}

double step_for(double range) {
  const double rough = range / 5;
  for (const double step : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0}) {
    if (rough <= step) return step;
  }
  return 50;
}

/// Stretches of a trace in one layer each; entry and exit are depths, or times.
template <class Trace, class X>
std::vector<TissueInterval> bands_of(const Trace& trace, X x_of) {
  std::vector<TissueInterval> bands;
  for (const TracePoint& p : trace) {
    if (!p.felt) continue;
    const double x = x_of(p);
    if (bands.empty() || bands.back().region != p.region) {
      TissueInterval band;
      band.entry = band.exit = x;
      band.region = static_cast<RegionId>(p.region);
      bands.push_back(band);
    }
    bands.back().entry = std::min(bands.back().entry, x);
    bands.back().exit = std::max(bands.back().exit, x);
  }
  return bands;
}

template <class Trace, class X>
void draw_curve(ImDrawList* list, const Plot& plot, const Trace& trace, X x_of,
                float TracePoint::*value, ImU32 colour) {
  std::vector<CurvePoint> curve;
  curve.reserve(trace.size());
  for (const TracePoint& p : trace) {
    const double x = x_of(p);
    if (x < plot.x_low || x > plot.x_high) continue;
    const ImVec2 at = plot.at(x, p.*value);
    curve.push_back({at.x, at.y});
  }
  std::vector<ImVec2> points;
  for (const CurvePoint& p : thinned(curve)) points.emplace_back(p.x, p.y);
  list->AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0,
                    ImGui::GetFontSize() / 9);
}

/// A task that is judged without aids does not tell in what the tip is.
bool tells_layers(const ViewState& state) {
  return state.lesson == nullptr || state.aids;
}

/// Bands of the layers below a curve; each name once, at the widest of its bands, where there is
/// room for it.
void draw_layers(ImDrawList* list, const Plot& plot, const PanelInput& in, Language language,
                 const std::vector<TissueInterval>& bands) {
  const CompiledJoint& joint = in.session->scene().joint();
  const auto colours = region_colours(joint);
  std::map<std::string, LabelBox> widest;
  list->PushClipRect(plot.from, plot.to, true);
  for (std::size_t k = 0; k < bands.size(); ++k) {
    const TissueInterval& band = bands[k];
    if (band.region == kOutside || band.exit <= plot.x_low || band.region >= colours.size())
      continue;
    const ImVec2 a = plot.at(std::max(band.entry, plot.x_low), plot.y_high);
    const ImVec2 b = plot.at(std::min(band.exit, plot.x_high), plot.y_low);
    list->AddRectFilled(a, b, to_imgui(colours[band.region], 70));
    LabelBox& box = widest[layer_name(language, joint, bands, k)];
    if (b.x - a.x <= std::max(box.width, 3.F)) continue;
    box = {a.x - plot.from.x, 1, b.x - a.x, ImGui::GetFontSize()};
  }
  std::vector<NamedPoint> names;
  for (const auto& [name, box] : widest)
    if (box.width > 0) names.push_back({name, box.x + box.width / 2, 1 + box.height / 2});
  std::sort(names.begin(), names.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  draw_names(list, plot.from, ImVec2(plot.to.x - plot.from.x, plot.to.y - plot.from.y), names);
  list->PopClipRect();
}

void draw_force_over_time(const PanelInput& in, const ViewState& state, Plot plot) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  plot.x_high = state.trace.empty() ? state.trace_seconds : state.trace.back().time;
  plot.x_low = plot.x_high - state.trace_seconds;
  const auto x = [](const TracePoint& p) {
    return p.time;
  };
  if (tells_layers(state)) draw_layers(list, plot, in, state.language, bands_of(state.trace, x));
  draw_frame(list, plot, step_for(plot.y_high - plot.y_low), state.language);
  if (in.probe.felt) draw_curve(list, plot, state.trace, x, &TracePoint::probe, kProbe);
  draw_curve(list, plot, state.trace, x, &TracePoint::lateral, kLateral);
  draw_curve(list, plot, state.trace, x, &TracePoint::force, kForce);
  const float font = ImGui::GetFontSize();
  list->AddText(ImVec2(plot.from.x, plot.to.y + 2), kText,
                translate(state, "resistance to insertion, N, last 10 s"));
  ImVec2 legend(plot.from.x + 4, plot.to.y - 1.2F * font);
  const auto name_curve = [&](const char* name, ImU32 colour) {
    list->AddText(legend, colour, translate(state, name));
    legend.x += ImGui::CalcTextSize(translate(state, name)).x + font;
  };
  name_curve(msgid("along"), kForce);
  name_curve(msgid("sideways"), kLateral);
  if (in.probe.felt) name_curve(msgid("probe"), kProbe);
}

void draw_force_over_depth(const PanelInput& in, const ViewState& state, Plot plot) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const std::vector<TracePoint>& trace = state.insertion.points();
  plot.x_low = 0;
  plot.x_high = 35;
  for (const TracePoint& p : trace) {
    plot.x_high = std::max(plot.x_high, p.depth / kMillimetre);
    plot.y_high = std::max<double>(plot.y_high, p.force * 1.1);
  }
  const auto x = [](const TracePoint& p) {
    return p.depth / kMillimetre;
  };
  std::vector<TracePoint> sorted = trace;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const TracePoint& a, const TracePoint& b) { return a.depth < b.depth; });
  if (tells_layers(state)) draw_layers(list, plot, in, state.language, bands_of(sorted, x));
  draw_frame(list, plot, step_for(plot.y_high - plot.y_low), state.language);
  draw_curve(list, plot, trace, x, &TracePoint::force, kForce);
  const std::string title =
      fill(translate(state, "insertion, {} mm"), {number(state.language, plot.x_high, 0)});
  list->AddText(ImVec2(plot.from.x, plot.to.y + 2), kText, title.c_str());
}

/// Bars of a histogram over time on a logarithmic axis, 1 us to 1 s.
void draw_histogram(ImDrawList* list, const Plot& plot, const LatencyHistogram& histogram,
                    ImU32 colour) {
  std::array<double, 96> bars{};
  for (int i = 0; i < LatencyHistogram::kBins; ++i) {
    const double decades = std::log10(std::max(LatencyHistogram::upper_edge(i), 1e3) / 1e3);
    const auto bar = static_cast<std::size_t>(std::clamp(decades / 6 * 96, 0.0, 95.0));
    bars[bar] += histogram.bin(i);
  }
  const auto total = static_cast<double>(std::max<std::uint64_t>(histogram.count(), 1));
  for (std::size_t i = 0; i < bars.size(); ++i) {
    if (bars[i] <= 0) continue;
    const double height = 1 + std::log10(bars[i] / total) / 6;  // six decades of share
    const double x = static_cast<double>(i) / 96;
    list->AddRectFilled(plot.at(x, std::max(height, 0.02)), plot.at(x + 1.0 / 96, 0), colour);
  }
}

void draw_limit(ImDrawList* list, const Plot& plot, double us, const char* text) {
  const double x = std::log10(us) / 6;
  list->AddLine(plot.at(x, 0), plot.at(x, 1), kLimit);
  const ImVec2 p = plot.at(x, 1);
  list->AddText(ImVec2(p.x + 2, p.y), kLimit, text);
}

void draw_times(const char* title, const LatencyHistogram& first, const LatencyHistogram& second,
                const Plot& plot, double limit_us, const char* limit) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRect(plot.from, plot.to, kAxis);
  for (int decade = 1; decade < 6; ++decade)
    list->AddLine(plot.at(decade / 6.0, 0), plot.at(decade / 6.0, 1), kGrid);
  draw_histogram(list, plot, second, IM_COL32(110, 170, 255, 150));
  draw_histogram(list, plot, first, IM_COL32(255, 120, 90, 170));
  draw_limit(list, plot, limit_us, limit);
  list->AddText(ImVec2(plot.from.x, plot.to.y + 1), kText, title);
}

Plot plot_in(const ImVec2& at, const ImVec2& size, float left) {
  Plot plot;
  const float font = ImGui::GetFontSize();
  plot.from = ImVec2(at.x + left, at.y + 2);
  plot.to = ImVec2(at.x + size.x - 4, at.y + size.y - 1.4F * font);
  return plot;
}

}  // namespace

void draw_force_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::force, msgid("Force"), state);
  if (!scope) return;
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float left = 2.5F * ImGui::GetFontSize();
  const float split = 0.6F * room.x;
  Plot time = plot_in(at, ImVec2(split, room.y), left);
  Plot depth = plot_in(ImVec2(at.x + split, at.y), ImVec2(room.x - split, room.y), left);
  time.y_low = depth.y_low = lowest_force(state.trace);
  depth.y_high = highest_force(state.trace);
  time.y_high = std::max(depth.y_high, highest_press(state.trace));
  draw_force_over_time(in, state, time);
  draw_force_over_depth(in, state, depth);
  ImGui::Dummy(room);
}

void draw_rates_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::rates, msgid("Rates"), state);
  if (!scope) return;
  const SessionTimes& t = in.session->times();
  const auto rate = [](const LatencyHistogram& h) {
    return h.count() > 0 ? 1e6 / std::max(h.percentile_us(0.5), 1.0) : 0.0;
  };
  const auto whole = [&state](double value) {
    return number(state.language, value, 0);
  };
  const std::string haptic_line =
      fill(translate(state, "haptics {} Hz, compute p99.9 {} us   late p99 {} us"),
           {whole(in.session->params().haptic_rate), whole(t.haptic_compute.percentile_us(0.999)),
            whole(t.haptic_lateness.percentile_us(0.99))});
  const std::string image_line =
      fill(translate(state, "images {} Hz, pose to image p95 {} ms   window {} Hz"),
           {whole(rate(t.image_interval)), whole(1e-3 * t.pose_to_image.percentile_us(0.95)),
            whole(in.window_rate)});
  for (const std::string& line : {haptic_line, image_line}) ImGui::TextWrapped("%s", line.c_str());
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const Plot haptics = plot_in(at, ImVec2(room.x, room.y / 2), 2);
  const Plot images = plot_in(ImVec2(at.x, at.y + room.y / 2), ImVec2(room.x, room.y / 2), 2);
  draw_times(translate(state, "haptics: compute, lateness; 1 us .. 1 s"), t.haptic_compute,
             t.haptic_lateness, haptics, 1e3, "1000 Hz");
  draw_times(translate(state, "images: render, interval; 1 us .. 1 s"), t.image_render,
             t.image_interval, images, 1e6 / 30, "30 Hz");
  ImGui::Dummy(room);
}

}  // namespace artus
