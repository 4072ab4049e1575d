// SPDX-License-Identifier: AGPL-3.0-or-later
// Clamping and re-direction (source Figs. 2-16, 2-17).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "artus/core/units.h"
#include "artus/evidence/needle/experiment_list.h"

namespace artus {
namespace {

Vec3 tilted(double degrees) {
  return {std::sin(degrees * kDegree), 0, std::cos(degrees * kDegree)};
}

std::string in_words(const char* before, double value, const char* after) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%s%.3f%s", before, value, after);
  return text.data();
}

double tilt_of(const Vec3& axis) {
  return std::atan2(axis.x(), axis.z()) / kDegree;
}

}  // namespace

Experiment run_clamp_redirect(const ExperimentOptions& options, const DeviceLimits& device) {
  constexpr double kAside = 5;   // degrees the hand strays off its line before withdrawing
  constexpr double kAimed = 15;  // degrees of the new line
  BodyExperiment e;
  e.layers = {plain_layer(1.5, 500, 0.4)};
  e.layers[0].tissue.clamping_stiffness = 300;
  e.layers[0].tissue.friction = 1;
  e.device = device;
  e.feel = options.feel;
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
  Experiment out;
  out.title = "Clamping and re-direction";
  out.source = "[Alamilla2020] Figs. 2-16 and 2-17, eqs. 1.2 and 2.20";
  out.traces = {{"", run_body(e), layer_names(1)}};
  const auto& rows = out.traces[0].rows;
  double first_tilt = 0;
  double last_tilt = 0;
  double redirected = -1;
  double shallow = 0;
  double deep = 0;
  double strayed = 0;
  double on_line = 0;
  double after = 0;
  double product = 0;
  double square = 0;
  std::vector<const NeedleRow*> held;
  for (const NeedleRow& r : rows) {
    if ((r.events & ContactEvent::kSkinPunctured) != 0) first_tilt = tilt_of(r.axis);
    if ((r.events & ContactEvent::kRedirected) != 0) redirected = r.time;
    if (r.depth <= 0.003) continue;
    last_tilt = tilt_of(r.axis);
    const double force = r.forces.clamping.norm();
    if (r.depth < 0.0115 && redirected < 0) on_line = std::max(on_line, force);
    if (redirected < 0) {
      strayed = std::max(strayed, force);
      const double spring = r.deviation * r.depth;  // clamping grows with both
      product += force * spring;
      square += spring * spring;
      held.push_back(&r);
      const bool off = r.deviation > 0.3 * kMillimetre;
      if (off && r.depth < 0.015) shallow = std::max(shallow, force / r.deviation);
      if (off && r.depth > 0.022) deep = std::max(deep, force / r.deviation);
    } else if (r.time > redirected + 0.2 && r.state == ContactState::inserting) {
      after = std::max(after, force);
    }
  }
  double off_line = 0;
  const double slope = square > 0 ? product / square : 0;
  for (const NeedleRow* r : held) {
    off_line =
        std::max(off_line, std::abs(r->forces.clamping.norm() - slope * r->deviation * r->depth));
  }
  out.claims = {
      claim_at_least(ClaimKind::input, "largest clamping force while off the line", strayed, 0.1,
                     "N"),
      claim_at_most(ClaimKind::input,
                    "clamping force off deviation * depth * constant, share of the largest",
                    off_line / std::max(strayed, 1e-9), 0.05, ""),
      claim_at_least(ClaimKind::input, "lateral stiffness beyond 22 mm over that before 15 mm",
                     deep / shallow, 1.4, ""),
      claim_near(ClaimKind::input, "the new line after withdrawal, degrees from the first",
                 last_tilt - first_tilt, kAimed, 0.15, "degrees"),
      claim_at_most(ClaimKind::input, "clamping force on the new line over the largest before",
                    after / std::max(strayed, 1e-9), 0.5, "")};
  out.published = {
      {"on the line", "the force tends towards zero", in_words("at most ", on_line, " N")},
      {"leaving the line, deeper and deeper", "the force starts to rise",
       in_words("to ", strayed, " N")},
      {"withdrawn in part and re-aimed", "the new trajectory is taken",
       in_words("line turned by ", last_tilt - first_tilt, " degrees")}};
  out.plot.title = out.title + " (Figs. 2-16 and 2-17)";
  out.plot.panels = {
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
  return out;
}

}  // namespace artus
