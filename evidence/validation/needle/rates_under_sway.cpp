// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/needle/rates_under_sway.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/needle/experiment_body.h"

namespace artus {
namespace {

constexpr std::array<double, 3> kSwayRates{1000, 2000, 10000};
// m that the hand means to draw back to: deep, where a layer begins, near the skin, outside.
constexpr std::array<double, 5> kBack{0.012, 0.004, 0.0025, 0.001, -0.001};

/// A corner of what the hand means: when, s, and how deep, m.
struct Corner {
  double time = 0;
  double depth = 0;
};

// In, a rest, back, a short rest, in again, a rest.
std::vector<Corner> corners(double back) {
  constexpr double kOutside = -0.005;  // m
  constexpr double kDeep = 0.026;      // m
  constexpr double kAgain = 0.024;     // m
  constexpr double kIn = 0.015;        // m/s
  constexpr double kOut = 0.020;       // m/s
  std::vector<Corner> out{{0, kOutside}, {0.2, kOutside}};
  const auto go = [&out](double to, double speed) {
    out.push_back({out.back().time + std::abs(to - out.back().depth) / speed, to});
  };
  const auto rest = [&out](double time) {
    out.push_back({out.back().time + time, out.back().depth});
  };
  go(kDeep, kIn);
  rest(0.3);
  go(back, kOut);
  rest(0.05);
  go(kAgain, kIn);
  rest(0.5);
  return out;
}

Intention swaying(const std::vector<Corner>& line, double phase, double t) {
  std::size_t i = 1;
  while (i + 1 < line.size() && line[i].time <= t) ++i;
  const Corner& a = line[i - 1];
  const Corner& b = line[i];
  const double share = std::clamp((t - a.time) / (b.time - a.time), 0.0, 1.0);
  constexpr double kAside = 1e-3;        // m
  constexpr double kTurns = kTwoPi * 4;  // rad/s
  const double turned = kTurns * t + phase;
  Intention want;
  want.X_JN = make_pose(Vec3(kAside * std::sin(turned), 0, a.depth + share * (b.depth - a.depth)),
                        Vec3::UnitZ(), Vec3::UnitX());
  const double speed = share < 1 ? (b.depth - a.depth) / (b.time - a.time) : 0;
  want.velocity = Vec3(kAside * kTurns * std::cos(turned), 0, speed);
  return want;
}

std::vector<LayerHaptics> layers(bool membranes) {
  std::vector<LayerHaptics> out{plain_layer(1, 1500, 0.25), plain_layer(2, 500, 0.5),
                                plain_layer(1.5, 500, 0.375), plain_layer(2.5, 500, 0.625)};
  for (LayerHaptics& layer : out) {
    layer.tissue.friction = 1;
    layer.tissue.clamping_stiffness = 200;
  }
  if (membranes) {
    out[0].tissue.puncture_force = 1.5;
    out[2].tissue.puncture_force = 2;
  }
  return out;
}

/// Total force as the motor holds it, at 10 kHz, frame J.
std::vector<Vec3> run_sway_at(double rate, double back, bool membranes,
                              const ExperimentOptions& options, const DeviceLimits& device) {
  const std::vector<Corner> line = corners(back);
  BodyExperiment e;
  e.body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, 0.004, 0.018, 0.021});
  e.layers = layers(membranes);
  e.feel = options.feel;
  e.tissue = options.tissue;
  e.device = device;
  e.hand.tremor_rms = 0;
  e.rate_hz = rate;
  const double phase = static_cast<double>(options.seed % 20) * kTwoPi / 20;
  e.path = [&line, phase](double t) {
    return swaying(line, phase, t);
  };
  e.path_duration = line.back().time;
  const auto held = static_cast<std::size_t>(std::lround(kSwayRates.back() / rate));
  std::vector<Vec3> out;
  run_body(e, [held, &out](const NeedleRow& row) {
    out.insert(out.end(), held, row.forces.total.force);
  });
  return out;
}

/// Sums of squares, N^2.
struct Squares {
  double total = 0;
  double aside = 0;
  Squares& operator+=(const Squares& other) {
    total += other.total;
    aside += other.aside;
    return *this;
  }
};

Squares squares(const Vec3& force) {
  return {force.squaredNorm(), force.head<2>().squaredNorm()};
}

/// RMS shares of the difference to 10 kHz, at 1 and at 2 kHz.
struct SwayShares {
  std::array<double, 2> total{};
  std::array<double, 2> aside{};
};

/// All depths together; a row for each in `out`.
SwayShares sway_differences(bool membranes, const ExperimentOptions& options,
                            const DeviceLimits& device, Experiment& out) {
  std::array<Squares, 2> off;
  Squares size;
  for (const double back : kBack) {
    const std::vector<Vec3> fastest =
        run_sway_at(kSwayRates.back(), back, membranes, options, device);
    Squares here;
    for (const Vec3& force : fastest) here += squares(force);
    std::array<std::string, 2> cells;
    for (std::size_t i = 0; i < off.size(); ++i) {
      const std::vector<Vec3> held = run_sway_at(kSwayRates[i], back, membranes, options, device);
      Squares difference;
      for (std::size_t k = 0; k < std::min(held.size(), fastest.size()); ++k)
        difference += squares(held[k] - fastest[k]);
      off[i] += difference;
      cells[i] = to_csv(std::sqrt(difference.total / here.total));
    }
    size += here;
    out.tables.front().second.rows.push_back(
        {"sway back to " + to_csv(back / kMillimetre) + " mm" +
             (membranes ? " with membranes" : " without membranes"),
         std::string(device.name), "no tremor", cells[0], cells[1]});
  }
  SwayShares shares;
  for (std::size_t i = 0; i < off.size(); ++i) {
    shares.total[i] = std::sqrt(off[i].total / size.total);
    shares.aside[i] = std::sqrt(off[i].aside / size.aside);
  }
  return shares;
}

}  // namespace

void compare_rates_under_sway(const ExperimentOptions& options, Experiment& out) {
  const std::string hand = "a hand that sways, back to five depths and in again";
  const auto against = [](std::size_t i) {
    return " at " + to_csv(kSwayRates[i]) + " Hz against 10 kHz, RMS share";
  };
  std::array<double, 2> aside{};
  for (const DeviceLimits& device : device_table()) {
    for (const bool membranes : {true, false}) {
      const SwayShares off = sway_differences(membranes, options, device, out);
      for (std::size_t i = 0; i < aside.size(); ++i) {
        aside[i] = std::max(aside[i], off.aside[i]);
        std::string text = hand + ", " + std::string(device.name);
        text += membranes ? ", membranes: total force" : ", no membranes: total force";
        out.claims.push_back(
            claim_at_most(ClaimKind::independent, text.append(against(i)), off.total[i], 0.02, ""));
      }
    }
  }
  for (std::size_t i = 0; i < aside.size(); ++i) {
    out.claims.push_back(claim_at_most(
        ClaimKind::independent, hand + ", worst device and body: force aside alone" + against(i),
        aside[i], 0.02, ""));
  }
}

}  // namespace artus
