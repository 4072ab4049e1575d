// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/echo/probe/gaussian.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "artus/detail/evidence/validation/echo/echo_gates.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

/// Silent tissue at the display's speed: the needle alone.
/// Grey (0..1 of 60 dB) of a shaft where it passes below the middle line at 15 mm.
double shaft_grey(Renderer& renderer, double degrees, bool echogenic) {
  constexpr double kRange = 60;  // dB
  const double angle = degrees * kDegree;
  const Vec3 tip = Vec3(0, 0, 15e-3) + 6e-3 * Vec3(std::cos(angle), 0, std::sin(angle));
  NeedleShape shape;
  shape.echogenic = echogenic;
  const Frame& frame =
      renderer.render(Pose::Identity(), needle_in_plane(Pose::Identity(), tip, angle, shape));
  return 1 + decibel(peak_value(frame, 128, 12e-3, 15.5e-3)) / kRange;
}

cv::Mat needle_picture(double degrees) {
  PhantomOptions options;
  options.needle_angle = degrees * kDegree;
  options.needle_depth = 15e-3;
  const auto phantom = make_echo_phantom("needle", options);
  return annotated_image(render_bmode(phantom->scene, phantom->X_JP, phantom->needle),
                         Transducer{});
}

/// Where a profile of width `fwhm` (Gaussian) convolved with a shaft of `diameter` is at half.
double expected_half_offset(double fwhm, double diameter) {
  const double scale = fwhm * kSigmaPerWidth * std::sqrt(2.0);
  std::vector<double> offset;
  std::vector<double> value;
  for (int k = 0; k < 400; ++k) {
    const double y = 0.01e-3 * k;
    offset.push_back(y);
    value.push_back(std::erf((y + diameter / 2) / scale) - std::erf((y - diameter / 2) / scale));
  }
  return full_width(offset, value) / 2;
}

}  // namespace

Gate gate_needle_rings() {
  Gate gate;
  gate.title = "22 G needle parallel to the face, 20 mm deep: lines below it every 0.51 mm";
  gate.assumed = {
      "outer diameter and bore of the gauge (nominal catalogue values), 5800 m/s in steel, water "
      "in "
      "the bore; how fast the lines decay"};
  Renderer renderer(make_clear_block(), Transducer{}, bare_settings());
  const Frame& frame = renderer.render(Pose::Identity(),
                                       needle_in_plane(Pose::Identity(), Vec3(12e-3, 0, 20e-3), 0));
  const auto line = envelope_line(frame, 128);
  std::vector<double> peaks;
  std::vector<double> heights;
  PlotSeries curve{"envelope below the needle", {}, {}};
  const auto first = static_cast<std::size_t>(18.5e-3 / frame.sample_depth);
  const auto last = static_cast<std::size_t>(25e-3 / frame.sample_depth);
  for (std::size_t i = first; i < last; ++i) {
    curve.x.push_back(static_cast<double>(i) * frame.sample_depth / kMillimetre);
    curve.y.push_back(decibel(std::max(1e-6, static_cast<double>(line[i]))));
    if (line[i] > line[i - 1] && line[i] >= line[i + 1] && line[i] > 0.01F) {
      peaks.push_back(curve.x.back());
      heights.push_back(line[i]);
    }
  }
  const ClaimBasis of_the_formula(ClaimKind::input, "lines are put in by wall, bore and decay");
  gate.claims.push_back(
      claim_at_least(of_the_formula, "lines seen", static_cast<double>(peaks.size()), 5, ""));
  bool decaying = true;
  for (std::size_t k = 1; k < std::min<std::size_t>(5, peaks.size()); ++k) {
    gate.claims.push_back(claim_within(of_the_formula, "spacing " + std::to_string(k),
                                       peaks[k] - peaks[k - 1], 0.51, 0.05, "mm"));
    decaying = decaying && heights[k] < heights[k - 1];
  }
  gate.claims.push_back(
      claim_that(of_the_formula, "each line weaker than the one above", decaying));
  gate.plots.push_back(
      {"", {"lines below a needle", {{"depth, mm", "dB below a mirror", {curve}}}}});
  add_picture(gate, "needle-0", needle_picture(0));
  return gate;
}

Gate gate_needle_angle() {
  Gate gate;
  gate.title =
      "Grey of a needle by its angle to the face ([SchafhalterZoppoth2004], [Nichols2003])";
  gate.assumed = {
      "the mean slope of a shaft's surface, fitted to the published value at 75 degrees of plain "
      "and "
      "of echogenic needles: those two claims hold the chain, not the physics"};
  Renderer renderer(make_clear_block(), Transducer{}, bare_settings());
  PlotSeries plain{"plain", {}, {}, PlotStyle::line_points};
  PlotSeries dimpled{"echogenic", {}, {}, PlotStyle::line_points};
  for (int degrees = 0; degrees <= 75; degrees += 5) {
    for (PlotSeries* series : {&plain, &dimpled}) {
      series->x.push_back(degrees);
      series->y.push_back(shaft_grey(renderer, degrees, series == &dimpled));
    }
  }
  const ClaimBasis of_the_law(ClaimKind::fitted,
                              "the law of slopes was chosen for a grey that falls straight");
  const ClaimBasis of_the_slope(ClaimKind::fitted, "the mean slope was chosen by this value");
  constexpr std::size_t kTo65 = 14;  // values from 0 to 65 degrees
  double steepest_rise = -1;
  for (std::size_t i = 1; i < kTo65; ++i)
    steepest_rise = std::max(steepest_rise, plain.y[i] - plain.y[i - 1]);
  const LineFit fit = fit_line({plain.x.data(), kTo65}, {plain.y.data(), kTo65});
  gate.claims.push_back(claim_at_most(of_the_law, "largest rise in 5 degrees, 0-65 degrees",
                                      steepest_rise, 0, "of full grey"));
  gate.claims.push_back(claim_at_least(of_the_law, "correlation of grey with the angle, negative",
                                       -fit.correlation, 0.95, ""));
  gate.claims.push_back(claim_within(of_the_slope, "plain at 75 degrees over 0 degrees",
                                     100 * plain.y.back() / plain.y.front(), 10, 3, "%"));
  gate.claims.push_back(claim_within(of_the_slope, "echogenic at 75 degrees over 0 degrees",
                                     100 * dimpled.y.back() / dimpled.y.front(), 60, 5, "%"));
  gate.plots.push_back(
      {"",
       {"needle by angle", {{"angle to the face, degrees", "grey of 60 dB", {plain, dimpled}}}}});
  for (const int degrees : {10, 30, 50})
    add_picture(gate, "needle-" + std::to_string(degrees), needle_picture(degrees));
  return gate;
}

Gate gate_needle_offset() {
  Gate gate;
  gate.title =
      "Offset from the plane at which a 22 G needle is half as bright: the slice of the wave "
      "model, "
      "convolved with the shaft";
  gate.assumed = {"outer diameter of the gauge (nominal catalogue value)"};
  Renderer renderer(make_clear_block(), Transducer{}, bare_settings());
  const NeedleShape shape;
  constexpr double kStep = 0.05e-3;  // m
  PlotPanel panel{"offset, mm", "brightness over the centred one", {}};
  double steepest = 0;
  for (const auto& [depth, width] :
       {std::pair(10e-3, 2.3e-3), {20e-3, 0.43e-3}, {30e-3, 1.95e-3}}) {
    std::vector<double> offset;
    std::vector<double> value;
    for (int k = 0; k < 60; ++k) {
      offset.push_back(k * kStep);
      const Vec3 tip(12e-3, offset.back(), depth);
      const Frame& frame =
          renderer.render(Pose::Identity(), needle_in_plane(Pose::Identity(), tip, 0, shape));
      value.push_back(peak_value(frame, 128, depth - 2e-3, depth + 1e-3));
    }
    const double half = full_width(offset, value) / 2;
    const std::string deep = printed("%.0f mm deep", depth / kMillimetre);
    gate.claims.push_back(
        claim_near(ClaimKind::independent, "half-brightness offset " + deep, half / kMillimetre,
                   expected_half_offset(width, shape.outer_diameter) / kMillimetre, 0.2, "mm"));
    PlotSeries series;
    series.label = deep;
    for (std::size_t i = 0; i < offset.size(); ++i) {
      series.x.push_back(offset[i] / kMillimetre);
      series.y.push_back(value[i] / value.front());
      if (i > 0) steepest = std::max(steepest, series.y[i - 1] - series.y[i]);
    }
    panel.series.push_back(series);
  }
  gate.claims.push_back(claim_at_most(
      ClaimKind::independent, "steepest fall in 0.05 mm: never a step", 100 * steepest, 30, "%"));
  gate.plots.push_back({"", {"needle beside the plane", {panel}}});
  return gate;
}

}  // namespace artus
