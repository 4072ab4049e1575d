// SPDX-License-Identifier: AGPL-3.0-or-later
// Clamping and re-direction (source Figs. 2-16, 2-17).
#include <algorithm>
#include <cmath>

#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/needle/experiments.h"

namespace artus {
namespace {

Vec3 tilted(double degrees) {
  return {std::sin(degrees * kDegree), 0, std::cos(degrees * kDegree)};
}

double tilt_of(const Vec3& axis) {
  return std::atan2(axis.x(), axis.z()) / kDegree;
}

constexpr double kAside = 5;   // degrees the hand strays off its line before withdrawing
constexpr double kAimed = 15;  // degrees of the new line

BodyExperiment make_body(const ExperimentOptions& options, const DeviceLimits& device) {
  BodyExperiment e;
  e.layers = {plain_layer(1.5, 500, 0.4)};
  e.layers[0].tissue.clamping_stiffness = 300;
  e.layers[0].tissue.friction = 1;
  e.device = device;
  e.feel = options.feel;
  e.tissue = options.tissue;
  e.hand.seed = options.seed;
  e.phases = {stay(0.3),
              push_to(0.012, 0.012),
              aim(tilted(kAside), 0.6),  // leaves the line while it is held
              push_to(0.026, 0.012),
              stay(0.5),
              pull_to(0.012, 0.015),  // part of the way
              stay(0.3),
              aim(tilted(kAimed), 0.8),
              push_to(0.026, 0.012),
              stay(0.5),
              pull_to(-0.004, 0.02)};
  return e;
}

// Forces in N, tilts in degrees, lateral stiffnesses in N/m.
struct Clamped {
  double first_tilt = 0;
  double last_tilt = 0;
  double redirected = -1;  // s, -1: never
  double on_line = 0;      // the largest before the hand strays
  double strayed = 0;      // the largest before the new line
  double shallow = 0;      // before 15 mm
  double deep = 0;         // beyond 22 mm
  double after = 0;        // the largest while the new line is followed
  double off_law = 0;      // the largest off the best multiple of deviation * depth
};

void measure_held(const NeedleRow& r, Clamped& out) {
  const double force = r.forces.clamping.norm();
  if (r.depth < 0.0115) out.on_line = std::max(out.on_line, force);
  out.strayed = std::max(out.strayed, force);
  if (r.deviation <= 0.3 * kMillimetre) return;
  if (r.depth < 0.015) out.shallow = std::max(out.shallow, force / r.deviation);
  if (r.depth > 0.022) out.deep = std::max(out.deep, force / r.deviation);
}

Clamped measure_clamping(const std::vector<NeedleRow>& rows) {
  Clamped out;
  double product = 0;
  double square = 0;
  std::vector<const NeedleRow*> held;
  for (const NeedleRow& r : rows) {
    if ((r.events & ContactEvent::kSkinPunctured) != 0) out.first_tilt = tilt_of(r.axis);
    if ((r.events & ContactEvent::kRedirected) != 0) out.redirected = r.time;
    if (r.depth <= 0.003) continue;
    out.last_tilt = tilt_of(r.axis);
    if (out.redirected < 0) {
      measure_held(r, out);
      const double spring = r.deviation * r.depth;  // clamping grows with both
      product += r.forces.clamping.norm() * spring;
      square += spring * spring;
      held.push_back(&r);
    } else if (r.time > out.redirected + 0.2 && r.state == ContactState::inserting) {
      out.after = std::max(out.after, r.forces.clamping.norm());
    }
  }
  const double slope = square > 0 ? product / square : 0;
  for (const NeedleRow* r : held)
    out.off_law = std::max(out.off_law,
                           std::abs(r->forces.clamping.norm() - slope * r->deviation * r->depth));
  return out;
}

Plot make_plot(const std::string& title, const std::vector<NeedleRow>& rows) {
  Plot plot{title + " (Figs. 2-16 and 2-17)", {}};
  plot.panels = {
      {"time (s)",
       "depth (mm)",
       {plot_rows(rows, "depth", [](const NeedleRow& r) { return r.depth / kMillimetre; })}},
      {"time (s)",
       "angle (degrees)",
       {plot_rows(rows, "tilt of the line", [](const NeedleRow& r) { return tilt_of(r.axis); }),
        plot_rows(rows, "cone alpha", [](const NeedleRow& r) { return r.cone / kDegree; })}},
      {"time (s)",
       "off the line (mm)",
       {plot_rows(rows, "deviation",
                  [](const NeedleRow& r) { return r.deviation / kMillimetre; })}},
      {"time (s)",
       "clamping force (N)",
       {plot_rows(rows, "f_x", [](const NeedleRow& r) { return r.forces.clamping.x(); }),
        plot_rows(rows, "f_y", [](const NeedleRow& r) { return r.forces.clamping.y(); }),
        plot_rows(rows, "f_z", [](const NeedleRow& r) { return r.forces.clamping.z(); }),
        plot_rows(rows, "magnitude",
                  [](const NeedleRow& r) { return r.forces.clamping.norm(); })}}};
  return plot;
}

std::vector<Claim> make_claims(const Clamped& c) {
  const double strayed = std::max(c.strayed, 1e-9);
  return {claim_at_least({ClaimKind::input, "clamping of 300 N/m"},
                         "largest clamping force while off the line", c.strayed, 0.1, "N"),
          claim_at_most({ClaimKind::input, "eq. 2.20"},
                        "clamping force off deviation * depth * constant, share of the largest",
                        c.off_law / strayed, 0.05, ""),
          claim_at_least({ClaimKind::input, "eq. 2.20"},
                         "lateral stiffness beyond 22 mm over that before 15 mm",
                         c.shallow > 0 ? c.deep / c.shallow : 0, 1.4, ""),
          claim_near({ClaimKind::input, "the direction in which the hand aims"},
                     "the new line after withdrawal, degrees from the first",
                     c.last_tilt - c.first_tilt, kAimed, 0.15, "degrees"),
          claim_at_most({ClaimKind::fitted, "the bound is artus' own"},
                        "clamping force on the new line over the largest before", c.after / strayed,
                        0.5, "")};
}

}  // namespace

Experiment run_clamp_redirect(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out;
  out.title = "Clamping and re-direction";
  out.source = "[Alamilla2020] Figs. 2-16 and 2-17, eqs. 1.2 and 2.20";
  out.traces = {{"", run_body(make_body(options, device)), layer_names(1)}};
  const Clamped c = measure_clamping(out.traces[0].rows);
  out.claims = make_claims(c);
  out.published = {
      {"on the line", "the force tends towards zero", "at most " + fixed(c.on_line, 3, "N")},
      {"leaving the line, deeper and deeper", "the force starts to rise",
       "to " + fixed(c.strayed, 3, "N")},
      {"withdrawn in part and re-aimed", "the new trajectory is taken",
       "line turned by " + fixed(c.last_tilt - c.first_tilt, 3, "degrees")}};
  out.assumed =
      assumed_with_hand({"a tissue of 1.5 N, 0.4 N out, 500 N/m, clamping 300 N/m at full depth",
                         "12 mm/s, 5 degrees off the line, 15 degrees to the new one",
                         "bounds: 0.1 N, 5 %, 1.4 times, half the largest force before"});
  out.plots = {{"", make_plot(out.title, out.traces[0].rows)}};
  return out;
}

}  // namespace artus
