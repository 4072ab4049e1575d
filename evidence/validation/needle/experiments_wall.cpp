// SPDX-License-Identifier: AGPL-3.0-or-later
// The tracking wall alone: movement, stop, both ways, and through many layers.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/runs/plateau.h"
#include "artus/detail/evidence/validation/needle/experiments.h"

namespace artus {
namespace {

constexpr double kWallSpeed = 0.01;   // m/s; assumed: the source's figures show 5 to 20 mm/s
constexpr double kStiffness = 500;    // N/m, K_t of the source
constexpr double kStateOfRest = 0.3;  // s before the needle moves

// Tissue that is drawn out holds the needle by at most K_t times its depth: m, nearer the skin it
// is less than `attracted` newtons.
double hold_ends(double attracted) {
  return attracted / kStiffness;
}

BodyExperiment one_layer(const ExperimentOptions& options, const DeviceLimits& device,
                         double attracted) {
  BodyExperiment e;
  e.layers = {plain_layer(1, kStiffness, attracted)};
  e.device = device;
  e.feel = options.feel;
  e.tissue = options.tissue;
  e.hand.seed = options.seed;
  return e;
}

Plot wall_plot(const std::string& title, const std::vector<NeedleRow>& rows) {
  Plot plot;
  plot.title = title;
  plot.panels = {
      {"time (s)",
       "beyond the skin (mm)",
       {plot_rows(rows, "tip", [](const NeedleRow& r) { return r.depth / kMillimetre; }),
        plot_rows(rows, "wall", [](const NeedleRow& r) { return r.wall / kMillimetre; })}},
      {"time (s)", "resistance (N)", {plot_rows(rows, "cutting + attracted", resistance)}}};
  return plot;
}

// The time at which `reached` first holds, s; the end when it never does.
template <class F>
double time_when(const std::vector<NeedleRow>& rows, F reached) {
  const auto at = std::find_if(rows.begin(), rows.end(), reached);
  return at == rows.end() ? rows.back().time : at->time;
}

// The largest magnitude; infinite when there is none, so that nothing holds of rows that are not
// there.
double worst(const std::vector<double>& values) {
  double top = values.empty() ? std::numeric_limits<double>::infinity() : 0;
  for (const double v : values) top = std::max(top, std::abs(v));
  return top;
}

bool is_cutting(const NeedleRow& r) {
  return r.state == ContactState::inserting;
}

// A stop beyond 10 mm, and what follows when the needle moves again.
struct Stop {
  double before = 0;                                       // N, the force when it begins
  std::vector<double> off_line;                            // share of it off the straight line to 0
  std::vector<double> rest;                                // N, after the line
  double crept = std::numeric_limits<double>::infinity();  // mm, until the needle moves again
  double rebuilt = 0;                                      // N
  double built_over = 0;                                   // mm
};

Stop measure_stop(const std::vector<NeedleRow>& rows, double settling) {
  Stop out;
  const auto stop = std::find_if(rows.begin(), rows.end(), [](const NeedleRow& r) {
    return r.state == ContactState::stopped && r.depth > 10 * kMillimetre;
  });
  if (stop == rows.end() || stop == rows.begin()) return out;
  out.before = resistance(*(stop - 1));
  for (auto r = stop; r != rows.end() && r->state == ContactState::stopped; ++r) {
    const double t = r->time - stop->time;
    if (t < settling)
      out.off_line.push_back((resistance(*r) - out.before * (1 - t / settling)) / out.before);
    else if (t > settling + 0.02)
      out.rest.push_back(resistance(*r));
  }
  double from_wall = 0;  // m, where the wall stands when the needle moves again
  for (auto r = stop; r != rows.end(); ++r) {
    if (r->time < stop->time + 1 || !is_cutting(*r)) continue;
    if (out.rebuilt == 0) {
      from_wall = r->wall;
      out.crept = std::abs(from_wall - stop->depth) / kMillimetre;
    }
    out.rebuilt = std::max(out.rebuilt, resistance(*r));
    if (out.built_over == 0 && resistance(*r) > 0.999)
      out.built_over = (r->depth - from_wall) / kMillimetre;
  }
  return out;
}

}  // namespace

Experiment run_wall_move(const ExperimentOptions& options, const DeviceLimits& device) {
  BodyExperiment e = one_layer(options, device, 0);
  e.start_outside = kWallSpeed * 0.35;
  e.phases = {stay(kStateOfRest), push_to(15 * kMillimetre, kWallSpeed)};
  Experiment out;
  out.title = "Wall updated with movement: K_t 500 N/m, 1 N";
  out.source = "[Alamilla2020] Fig. 2-5, eqs. 2.14 and 2.15";
  out.traces = {{"", run_body(e), layer_names(1)}};
  const auto& rows = out.traces[0].rows;
  std::vector<double> rise;
  std::vector<double> level;
  for (const NeedleRow& r : rows) {
    if (!is_cutting(r)) continue;
    if (r.depth < 2 * kMillimetre) {
      rise.push_back(resistance(r) - kStiffness * r.depth);
    } else if (r.depth > 2.1 * kMillimetre) {
      level.push_back(resistance(r) - 1);
    }
  }
  out.claims = {
      claim_at_most({ClaimKind::input, "K_t of the layer, eq. 2.15"},
                    "over the first 2 mm the force is K_t x within", worst(rise), 0.01, "N"),
      claim_at_most({ClaimKind::input, "f_R of the layer"}, "then 1 N while moving, off by",
                    worst(level), 0.01, "N")};
  const double full = time_when(rows, [](const NeedleRow& r) { return resistance(r) > 0.9999; });
  out.published = {
      {"safety position f_R / K_t", "2 mm",
       fixed((rows.back().depth - rows.back().wall) / kMillimetre, 3, "mm")},
      {"force while the needle moves on", "1 N", fixed(resistance(rows.back()), 3, "N")},
      {"1 N is reached", "at 1.2 s, the hand's speed is not printed",
       "at " + fixed(full, 2, "s") + ", at 10 mm/s"}};
  out.assumed = assumed_with_hand(
      {"speed, 10 mm/s, and the start that lets it reach the skin at the published 0.65 s"});
  out.plots = {{"", wall_plot(out.title + " (Fig. 2-5)", rows)}};
  return out;
}

Experiment run_wall_stop(const ExperimentOptions& options, const DeviceLimits& device) {
  BodyExperiment e = one_layer(options, device, 0);
  e.entry = Vec3(0, 0, 0.15);
  e.body = AnalyticBody::make_stack(e.entry, e.direction, {0});
  e.phases = {stay(kStateOfRest), push_to(12 * kMillimetre, kWallSpeed), stay(1.5),
              push_to(20 * kMillimetre, kWallSpeed)};
  Experiment out;
  out.title = "Wall updated with a stop: w0 15 cm, stop about 1.5 s, move again";
  out.source = "[Alamilla2020] Fig. 2-6, eqs. 2.16 and 2.17";
  out.traces = {{"", run_body(e), layer_names(1)}};
  const auto& rows = out.traces[0].rows;
  const Stop stop = measure_stop(rows, e.needle.wall.settling_time);
  out.claims = {claim_at_most({ClaimKind::input, "eq. 2.16 with its settling time"},
                              "off a straight line over the settling time, share of the force",
                              worst(stop.off_line), 0.1, ""),
                claim_at_most({ClaimKind::input, "eq. 2.16"},
                              "afterwards the force stays 0, at most", worst(stop.rest), 0.05, "N"),
                claim_near({ClaimKind::input, "f_R of the layer"},
                           "moving again the force builds to", stop.rebuilt, 1, 0.01, "N"),
                claim_near({ClaimKind::input, "f_R / K_t of the layer"}, "over", stop.built_over, 2,
                           0.02, "mm"),
                claim_at_most({ClaimKind::fitted, "the bound is artus' own"},
                              "the needle leaves the place of its stop before that by", stop.crept,
                              0.4, "mm")};
  out.published = {
      {"force before the stop", "1 N", fixed(stop.before, 3, "N")},
      {"force during the stop", "decreases until 0", fixed(worst(stop.rest), 3, "N")},
      {"settling", "n iterations, tuned by controller",
       fixed(e.needle.wall.settling_time, 2, "s at any rate")},
      {"moving again", "increases gradually",
       "to " + fixed(stop.rebuilt, 3, "N") + " over " + fixed(stop.built_over, 2, "mm")}};
  out.assumed = assumed_with_hand({"speed, 10 mm/s", "settling time, 0.2 s",
                                   "bounds: a tenth of the force off the line, 0.05 N at rest, "
                                   "0.4 mm of creeping"});
  out.plots = {{"", wall_plot(out.title + " (Fig. 2-6)", rows)}};
  return out;
}

Experiment run_wall_both(const ExperimentOptions& options, const DeviceLimits& device) {
  BodyExperiment e = one_layer(options, device, 0.5);
  e.entry = Vec3(0, 0, 0.07);
  e.body = AnalyticBody::make_stack(e.entry, e.direction, {0});
  e.phases = {stay(kStateOfRest), push_to(25 * kMillimetre, kWallSpeed), stay(2.5),
              pull_to(-4 * kMillimetre, 0.015), stay(0.3)};
  Experiment out;
  out.title = "Cutting and attracted force: 1 N in, 0.5 N out, w0 7 cm";
  out.source = "[Alamilla2020] Fig. 2-10, eq. 2.19";
  out.traces = {{"", run_body(e), layer_names(1)}};
  const auto& rows = out.traces[0].rows;
  std::vector<double> in;
  std::vector<double> rest;
  std::vector<double> back;
  std::vector<double> outside;
  double still_since = 0;
  for (const NeedleRow& r : rows) {
    if (r.state != ContactState::stopped) still_since = r.time;
    if (is_cutting(r) && r.depth > 2.2 * kMillimetre && r.depth < 24 * kMillimetre)
      in.push_back(resistance(r) - 1);
    if (r.state == ContactState::stopped && r.time - still_since > 0.25)
      rest.push_back(resistance(r));
    if (r.state == ContactState::withdrawing && r.depth < 20 * kMillimetre &&
        r.depth > hold_ends(0.5)) {
      back.push_back(resistance(r) + 0.5);
    }
    if (r.state == ContactState::away) outside.push_back(resistance(r));
  }
  out.claims = {
      claim_at_most({ClaimKind::input, "f_R of the layer"}, "insertion: 1 N, off by", worst(in),
                    0.01, "N"),
      claim_at_most({ClaimKind::input, "eq. 2.16"}, "stop: 0 N, off by", worst(rest), 0.05, "N"),
      claim_at_most({ClaimKind::input, "f_A of the layer"},
                    "withdrawal: -0.5 N until 1 mm before the skin, off by", worst(back), 0.005,
                    "N"),
      claim_at_most({ClaimKind::input, "no force outside the body"}, "outside: 0 N, off by",
                    worst(outside), 0, "N"),
      claim_at_most({ClaimKind::input, "the wall is built to give none"},
                    "energy given over the cycle", rows.back().energy_to_hand, 0, "J")};
  const auto level = [&rows](ContactState state, double from, double to) {
    double sum = 0;
    double count = 0;
    for (const NeedleRow& r : rows) {
      if (r.state != state || r.depth < from || r.depth > to) continue;
      sum += resistance(r);
      ++count;
    }
    return fixed(sum / std::max(count, 1.0), 3, "N");
  };
  out.published = {{"insertion", "1 N", level(ContactState::inserting, 2.2e-3, 24e-3)},
                   {"intentional stop", "decreases until 0", fixed(worst(rest), 3, "N at most")},
                   {"withdrawal", "attracted force 0.5 N, drawn below zero",
                    level(ContactState::withdrawing, hold_ends(0.5), 20e-3)},
                   {"free motion", "no force", fixed(worst(outside), 3, "N at most")}};
  out.assumed = assumed_with_hand({"speeds, 10 mm/s in and 15 mm/s out"});
  out.plots = {{"", wall_plot(out.title + " (Fig. 2-10)", rows)}};
  return out;
}

namespace {

// Tip and wall along each axis, and the force with its magnitude, as the source draws them.
void add_axes(const std::vector<NeedleRow>& rows, const Vec3& entry, const Vec3& direction,
              Plot& plot) {
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  PlotPanel position{"time (s)", "tip P and wall w (mm)", {}};
  PlotPanel force{"time (s)", "cutting + attracted (N)", {}};
  for (Eigen::Index k = 0; k < 3; ++k) {
    const std::string axis = kAxes[static_cast<std::size_t>(k)];
    position.series.push_back(plot_rows(rows, "P_" + axis, [k](const NeedleRow& r) {
      return r.X_JN.translation()[k] / kMillimetre;
    }));
    PlotSeries wall = plot_rows(rows, "w_" + axis, [k, &entry, &direction](const NeedleRow& r) {
      return (entry + r.wall * direction)[k] / kMillimetre;
    });
    wall.style = PlotStyle::dashed;
    position.series.push_back(std::move(wall));
    force.series.push_back(plot_rows(
        rows, "f_" + axis, [k](const NeedleRow& r) { return -resistance(r) * r.axis[k]; }));
  }
  PlotSeries size =
      plot_rows(rows, "magnitude", [](const NeedleRow& r) { return std::abs(resistance(r)); });
  force.series.push_back(std::move(size));
  plot.panels.push_back(std::move(position));
  plot.panels.push_back(std::move(force));
}

// Runs through layers `forces` (N) and back, and claims each plateau within 1 %.
void run_layers(BodyExperiment& e, const std::vector<double>& forces, double attracted,
                Experiment& out) {
  std::vector<PlateauFinder::Layer> names(kFirstRegion);
  const auto labels = layer_names(forces.size());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    e.layers.push_back(plain_layer(forces[i], kStiffness, attracted));
    e.layers.back().tissue.clamping_stiffness = 300;
    names.push_back({labels[kFirstRegion + i], e.layers.back().tissue});
  }
  out.traces = {{"", run_body(e), labels}};
  PlateauFinder finder(names);
  for (const NeedleRow& r : out.traces[0].rows) finder.add(r);
  const auto plateaus = finder.plateaus();
  for (const LayerPlateau& p : plateaus) {
    const double off = std::max(std::abs(p.most - p.expected), std::abs(p.least - p.expected));
    out.claims.push_back(claim_near(
        {ClaimKind::input, "f_R of the layer"},
        p.tissue + " plateau, its row farthest off by " + to_csv(100 * off / p.expected) + " %",
        p.mean, p.expected, 0.01, "N"));
    if (off > 0.01 * p.expected || p.rows == 0) out.claims.back().pass = false;
  }
  out.claims.push_back(claim_near({ClaimKind::input, "the body's layers"}, "layers with a plateau",
                                  static_cast<double>(plateaus.size()),
                                  static_cast<double>(forces.size()), 0, ""));
  const auto& rows = out.traces[0].rows;
  for (const LayerPlateau& p : plateaus)
    out.published.push_back({p.tissue, fixed(p.expected, 1, "N"), fixed(p.mean, 3, "N")});
  Plot plot = wall_plot(out.title + " (" + out.source.substr(out.source.find("Fig")) + ")", rows);
  add_axes(rows, e.entry, e.direction, plot);
  plot.panels.push_back(
      {"time (s)", "off the line (mm)", {plot_rows(rows, "deviation", [](const NeedleRow& r) {
         return r.deviation / kMillimetre;
       })}});
  plot.panels.push_back(
      {"time (s)", "clamping (N)", {plot_rows(rows, "clamping", [](const NeedleRow& r) {
         return r.forces.clamping.norm();
       })}});
  out.plots = {{"", std::move(plot)}};
}

}  // namespace

Experiment run_wall_nine(const ExperimentOptions& options, const DeviceLimits& device) {
  constexpr double kRadius = 0.15;  // m
  constexpr double kLayer = 0.012;  // m; assumed
  BodyExperiment e;
  std::vector<double> radii;
  radii.reserve(9);
  for (int i = 0; i < 9; ++i) radii.push_back(kRadius - kLayer * i);
  e.body = AnalyticBody::make_balls(Vec3::Zero(), radii);
  e.direction = Vec3(-0.5, -0.4, -0.8).normalized();
  // Oblique: the line passes 20 mm beside the centre.
  const Vec3 aside = 0.02 * e.direction.unitOrthogonal();
  e.entry = aside - std::sqrt(kRadius * kRadius - aside.squaredNorm()) * e.direction;
  e.device = device;
  e.feel = options.feel;
  e.tissue = options.tissue;
  e.hand.seed = options.seed;
  e.needle.contact.needle_length = 0.15;
  e.phases = {stay(kStateOfRest), push_to(0.105, 0.02), stay(0.8), pull_to(-0.004, 0.05)};
  Experiment out;
  out.title = "Nine layers in a ball, oblique, with clamping";
  out.source = "[Alamilla2020] Figs. 2-12 and 2-13";
  run_layers(e, {1.5, 1, 1.8, 2, 3, 3.5, 2.5, 4, 4.5}, 0.5, out);
  double aside_max = 0;
  for (const NeedleRow& r : out.traces[0].rows) aside_max = std::max(aside_max, r.deviation);
  out.claims.push_back(
      claim_at_most({ClaimKind::input, "clamping of 300 N/m and a hand that means a straight line"},
                    "lateral deviation", aside_max / kMillimetre, 0.5, "mm"));
  out.assumed =
      assumed_with_hand({"layers of 12 mm, a line 20 mm beside the centre",
                         "clamping, 300 N/m at full depth", "speeds, 20 mm/s in and 50 mm/s out"});
  out.published.push_back({"the needle keeps its line", "drawn straight",
                           fixed(aside_max / kMillimetre, 3, "mm off at most")});
  return out;
}

Experiment run_wall_seven(const ExperimentOptions& options, const DeviceLimits& device) {
  BodyExperiment e;
  e.direction = Vec3(0.4, -0.5, 0.77).normalized();  // across the axes, as the source's; assumed
  e.body = AnalyticBody::make_stack(Vec3::Zero(), e.direction,
                                    {0, 0.008, 0.016, 0.024, 0.032, 0.040, 0.048});
  e.device = device;
  e.feel = options.feel;
  e.tissue = options.tissue;
  e.hand.seed = options.seed;
  e.needle.contact.needle_length = 0.09;
  constexpr double kFallSpeed = 0.015;  // m/s
  e.phases = {stay(kStateOfRest), push_to(0.056, kFallSpeed), stay(0.6), pull_to(-0.004, 0.05)};
  Experiment out;
  out.title = "Seven layers, attracted force 0.7 N";
  out.source = "[Alamilla2020] Figs. 2-14 and 2-15";
  run_layers(e, {0.5, 1, 1.5, 2, 0.7, 1, 1.5}, 0.7, out);
  const auto& rows = out.traces[0].rows;
  std::vector<double> back;
  double fall = 0;  // s from the interface until a twentieth of the step is left
  double entered = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].region == kFirstRegion + 4 && is_cutting(rows[i])) {
      if (rows[i - 1].region == kFirstRegion + 3) entered = rows[i].time;
      if (resistance(rows[i]) - 0.7 > 0.05 * (2 - 0.7)) fall = rows[i].time - entered;
    }
    if (rows[i].state == ContactState::withdrawing && rows[i].depth < 0.050 &&
        rows[i].depth > hold_ends(0.7)) {
      back.push_back(resistance(rows[i]) + 0.7);
    }
  }
  if (entered == 0) fall = std::numeric_limits<double>::infinity();
  out.claims.push_back(
      claim_at_most({ClaimKind::input, "layer's edge at 15 mm/s, three time constants of 3 ms"},
                    "2 N -> 0.7 N: until a twentieth of the step is left", fall,
                    e.needle.contact.layer_edge / kFallSpeed + 3 * 0.003, "s"));
  out.claims.push_back(claim_at_most({ClaimKind::input, "f_A of the layers"},
                                     "withdrawal: -0.7 N until 1.4 mm before the skin, off by",
                                     worst(back), 0.007, "N"));
  out.assumed = assumed_with_hand(
      {"layers of 8 mm and the direction", "clamping, 300 N/m at full depth",
       "speeds, 15 mm/s in and 50 mm/s out", "a weaker layer's fall, 3 ms (chosen by the rates)"});
  out.published.push_back({"from 2 N to a weaker layer", "almost instantaneous",
                           "in " + fixed(fall * 1e3, 2, "ms but for a twentieth")});
  out.published.push_back(
      {"attracted force", "0.7 N in all layers", "0.7 N, off by " + fixed(worst(back), 4, "N")});
  return out;
}

}  // namespace artus
