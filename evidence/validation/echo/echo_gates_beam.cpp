// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "artus/detail/evidence/validation/echo/echo_gates.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

constexpr std::array<double, 4> kDepths{10e-3, 20e-3, 30e-3, 40e-3};  // m

ImageSettings deep_settings() {
  ImageSettings settings = bare_settings();
  settings.depth = 45e-3;
  return settings;
}

std::string in_mm(double length) {
  return printed("%.4g mm", length / kMillimetre);
}

/// One point at each depth, `elevation` (m) beside the image's plane.
std::vector<PointReflector> points_beside(double elevation) {
  std::vector<PointReflector> points;
  points.reserve(kDepths.size());
  for (const double depth : kDepths) points.push_back({Vec3(0, elevation, depth), 1});
  return points;
}

/// Full width at half maximum of a point target at each depth, across the lines.
std::vector<double> lateral_widths(const std::shared_ptr<const Scene>& scene, double frequency) {
  Transducer transducer;
  transducer.frequency = frequency;
  transducer.n_lines = 1001;  // 0.04 mm apart: the width is read between lines
  Renderer renderer(scene, transducer, deep_settings());
  renderer.set_point_reflectors(points_beside(0));
  const Frame& frame = renderer.render(Pose::Identity());
  std::vector<double> widths;
  for (const double depth : kDepths) {
    std::vector<double> offset;
    std::vector<double> value;
    for (int l = 500; l < 560; ++l) {
      offset.push_back((l - 500) * transducer.pitch());
      value.push_back(peak_value(frame, l, depth - 1e-3, depth + 1e-3));
    }
    widths.push_back(full_width(offset, value));
  }
  return widths;
}

/// The same across the slice: the point moves out of the plane.
std::vector<double> slice_widths(const std::shared_ptr<const Scene>& scene, double height) {
  constexpr double kStep = 0.05e-3;  // m
  Transducer transducer;
  transducer.elevation_height = height;
  transducer.width = 2e-3;
  transducer.n_lines = 3;
  Renderer renderer(scene, transducer, deep_settings());
  std::vector<double> offset;
  std::array<std::vector<double>, kDepths.size()> value;
  for (int k = 0; k < 80; ++k) {
    offset.push_back(k * kStep);
    renderer.set_point_reflectors(points_beside(offset.back()));
    const Frame& frame = renderer.render(Pose::Identity());
    for (std::size_t i = 0; i < kDepths.size(); ++i)
      value[i].push_back(peak_value(frame, 1, kDepths[i] - 1e-3, kDepths[i] + 1e-3));
  }
  std::vector<double> widths;
  widths.reserve(value.size());
  for (const auto& curve : value) widths.push_back(full_width(offset, curve));
  return widths;
}

PlotSeries over_depth(std::string label, const std::vector<double>& widths,
                      PlotStyle style = PlotStyle::line_points) {
  PlotSeries series;
  series.label = std::move(label);
  series.style = style;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    series.x.push_back(kDepths[i] / kMillimetre);
    series.y.push_back(widths[i] / kMillimetre);
  }
  return series;
}

cv::Mat picture_of(const std::string& phantom_name) {
  const auto phantom = make_echo_phantom(phantom_name);
  Renderer renderer(phantom->scene, Transducer{}, raw_settings());
  renderer.set_point_reflectors(phantom->reflectors);
  return annotated_image(renderer.render(phantom->X_JP, phantom->needle), Transducer{});
}

}  // namespace

Gate gate_lateral_width() {
  Gate gate;
  gate.title =
      "Lateral width of point targets under dynamic aperture at F/2 (wave model: 0.25 mm at "
      "12 MHz, 0.39 mm at 7.6 MHz)";
  const auto scene = make_clear_block();
  PlotPanel panel{"depth, mm", "lateral width, mm", {}};
  for (const auto& [frequency, expected] : {std::pair(12e6, 0.25e-3), {7.6e6, 0.39e-3}}) {
    const auto widths = lateral_widths(scene, frequency);
    const std::string label = printed("%.3g MHz", frequency / 1e6);
    for (std::size_t i = 0; i < widths.size(); ++i)
      gate.claims.push_back(claim_near(
          {ClaimKind::input, "0.97 wavelengths times the F-number is the beam's own formula"},
          label + ", " + in_mm(kDepths[i]) + " deep", widths[i] / kMillimetre,
          expected / kMillimetre, 0.15, "mm"));
    panel.series.push_back(over_depth(label, widths));
    panel.series.push_back(over_depth(
        label + ", wave model", std::vector<double>(kDepths.size(), expected), PlotStyle::points));
  }
  gate.plots.push_back({"", {"lateral width of point targets", {panel}}});
  add_picture(gate, "points", picture_of("points"));
  return gate;
}

Gate gate_slice_width() {
  Gate gate;
  gate.title = "Slice thickness at point targets, 12 MHz, lens at 20 mm (wave model)";
  struct Row {
    double height;
    std::array<double, kDepths.size()> widths;  // m, of the wave model
  };
  const std::array<Row, 3> rows{{{4e-3, {1.4e-3, 0.64e-3, 1.0e-3, 1.6e-3}},
                                 {5e-3, {1.9e-3, 0.51e-3, 1.04e-3, 3.3e-3}},
                                 {6e-3, {2.3e-3, 0.43e-3, 1.95e-3, 4.3e-3}}}};
  const auto scene = make_clear_block();
  PlotPanel panel{"depth, mm", "slice thickness, mm", {}};
  for (const Row& row : rows) {
    const auto widths = slice_widths(scene, row.height);
    for (std::size_t i = 0; i < widths.size(); ++i)
      gate.claims.push_back(
          claim_near(ClaimKind::independent,
                     "elements " + in_mm(row.height) + " high, " + in_mm(kDepths[i]) + " deep",
                     widths[i] / kMillimetre, row.widths[i] / kMillimetre, 0.15, "mm"));
    panel.series.push_back(over_depth(in_mm(row.height) + " high", widths));
    panel.series.push_back(
        over_depth("wave model", {row.widths.begin(), row.widths.end()}, PlotStyle::points));
  }
  gate.plots.push_back({"", {"slice thickness", {panel}}});
  return gate;
}

}  // namespace artus
