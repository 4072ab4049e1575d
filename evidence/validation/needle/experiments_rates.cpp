// SPDX-License-Identifier: AGPL-3.0-or-later
// What must not depend on the loop's rate.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/needle/experiments.h"
#include "artus/detail/evidence/validation/needle/rates_under_sway.h"

namespace artus {
namespace {

// A body with all laws on, a hard last layer where bone is, and what the hand means: in, a rest of
// 0.8 s, out. Of time alone, so that the hand is the same at every rate.
struct Insertion {
  std::string name;
  std::vector<double> begins;     // m
  std::vector<double> forces;     // N
  std::vector<double> stiffness;  // N/m
  std::vector<double> membranes;  // N, 0: none
  bool bone = false;              // whether the last layer is
  double to = 0;                  // m; the tissue holds the tip back by some millimetres
  double in = 0;                  // m/s
  double out = 0;                 // m/s
  ClaimBasis basis{ClaimKind::independent};
};

constexpr double kFrom = -0.005;  // m
constexpr double kStart = 0.3;    // s

// What was set in view of which of them stands with each.
std::vector<Insertion> insertions() {
  return {{"table 4.2, 15 mm/s onto bone",
           {0, 0.004, 0.018, 0.021, 0.027, 0.030},
           {1, 2, 1.5, 2.5, 3, 4},
           {1500, 500, 500, 500, 500, 4000},
           {1.5, 0, 2, 0, 0, 0},
           true,
           0.0335,
           0.015,
           0.020,
           {ClaimKind::fitted, "the shaft friction's bounds were chosen on it"}},
          {"other layers, 8 mm/s onto bone",
           {0, 0.002, 0.010, 0.024, 0.026, 0.0345},
           {1, 0.6, 2.2, 1.5, 2.5, 4},
           {1500, 400, 500, 500, 600, 4000},
           {1.2, 0, 0, 1.8, 0, 0},
           true,
           0.0375,
           0.008,
           0.015},
          {"no bone, 30 mm/s, a hand that rests in the tissue",
           {0, 0.003, 0.012, 0.020},
           {1, 2, 1.5, 2.5},
           {1500, 500, 500, 500},
           {1.5, 0, 2, 0},
           false,
           0.028,
           0.030,
           0.040,
           {ClaimKind::fitted, "the band of stillness and the 3 ms were set with it in view"}},
          {"two membranes, 45 mm/s onto bone",
           {0, 0.003, 0.014, 0.019, 0.026},
           {1, 2, 1.5, 2.5, 4},
           {1500, 500, 400, 600, 4000},
           {1.5, 0, 1.8, 0, 0},
           true,
           0.029,
           0.045,
           0.045,
           {ClaimKind::fitted, "the 3 ms of what lets go were set with membranes in view"}}};
}

// A body and a speed drawn at random: three to five layers, some behind membranes, half of them on
// bone.
Insertion draw_insertion(std::uint64_t seed, std::uint64_t number) {
  std::uint64_t draws = 100 * number;
  const auto between = [seed, &draws](double low, double high) {
    return low + (high - low) * uniform_noise(seed, draws++);
  };
  Insertion i;
  i.name = "drawn " + std::to_string(number + 1);
  i.bone = between(0, 1) < 0.5;
  const auto layers = static_cast<std::size_t>(between(3, 6));
  double depth = 0;
  for (std::size_t k = 0; k < layers; ++k) {
    const bool skin = k == 0;
    const bool bone = i.bone && k + 1 == layers;
    i.begins.push_back(depth);
    depth += skin ? between(1.5e-3, 3e-3) : between(3e-3, 11e-3);
    i.forces.push_back(bone ? 4 : skin ? between(0.7, 1.3) : between(0.8, 3));
    i.stiffness.push_back(bone ? 4000 : skin ? 1500 : between(400, 800));
    const bool membrane = !bone && (skin || between(0, 1) < 0.4);
    i.membranes.push_back(membrane ? between(1, 2.2) : 0);
  }
  i.to = i.begins.back() + (i.bone ? 3e-3 : between(4e-3, 8e-3));
  i.in = between(0.008, 0.045);
  i.out = between(0.01, 0.045);
  return i;
}

double time_there(const Insertion& i) {
  return kStart + (i.to - kFrom) / i.in;
}

double time_back(const Insertion& i) {
  constexpr double kRest = 0.8;  // s
  return time_there(i) + kRest;
}

Intention in_and_out(const Insertion& i, double t) {
  Intention want;
  double depth = kFrom;
  double speed = 0;
  if (t >= time_back(i)) {
    depth = std::max(kFrom, i.to - i.out * (t - time_back(i)));
    speed = depth > kFrom ? -i.out : 0;
  } else if (t >= time_there(i)) {
    depth = i.to;
  } else if (t >= kStart) {
    depth = kFrom + i.in * (t - kStart);
    speed = i.in;
  }
  want.X_JN = make_pose(Vec3(0, 0, depth), Vec3::UnitZ(), Vec3::UnitX());
  want.velocity = Vec3(0, 0, speed);
  return want;
}

std::vector<LayerHaptics> layers_of(const Insertion& i) {
  std::vector<LayerHaptics> layers;
  for (std::size_t k = 0; k < i.forces.size(); ++k) {
    if (i.bone && k + 1 == i.forces.size()) {
      layers.push_back(bone_layer(i.forces[k], i.stiffness[k]));
      continue;
    }
    layers.push_back(plain_layer(i.forces[k], i.stiffness[k], 0.25 * i.forces[k]));
    layers.back().tissue.friction = 1;
    layers.back().tissue.clamping_stiffness = 200;
    layers.back().tissue.puncture_force = i.membranes[k];
  }
  return layers;
}

double axial(const NeedleRow& r) {
  return r.forces.total.force.dot(r.axis);
}

// What the motor holds, at 10 kHz: a slower loop's force stays until its next tick.
void hold_at_10khz(double force, double rate, std::vector<double>& out) {
  out.insert(out.end(), static_cast<std::size_t>(std::lround(10000 / rate)), force);
}

std::vector<double> held_at_10khz(const std::vector<NeedleRow>& rows, double rate) {
  std::vector<double> out;
  for (const NeedleRow& row : rows) hold_at_10khz(axial(row), rate, out);
  return out;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0;
  double size = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    difference += (a[i] - b[i]) * (a[i] - b[i]);
    size += a[i] * a[i];
  }
  return size > 0 ? std::sqrt(difference / size) : 1;
}

constexpr std::array<double, 3> kRates{1000, 2000, 10000};
constexpr std::uint64_t kTremorSeeds = 6;

BodyExperiment at_rate(double rate, const Insertion& insertion, const ExperimentOptions& options,
                       const DeviceLimits& device, const HandParams& hand) {
  constexpr double kAfter = 0.35;  // s outside
  BodyExperiment e;
  e.body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), insertion.begins);
  e.layers = layers_of(insertion);
  e.names = table_layer_names();
  e.feel = options.feel;
  e.tissue = options.tissue;
  e.device = device;
  e.hand = hand;
  e.rate_hz = rate;
  e.path = [&insertion](double t) {
    return in_and_out(insertion, t);
  };
  e.path_duration = time_back(insertion) + (insertion.to - kFrom) / insertion.out + kAfter;
  return e;
}

using Shares = std::array<double, 2>;  // at 1 and at 2 kHz

// RMS share of the difference to 10 kHz.
Shares differences(const Insertion& insertion, const ExperimentOptions& options,
                   const DeviceLimits& device, const HandParams& hand) {
  std::array<std::vector<double>, kRates.size()> forces;
  for (std::size_t i = 0; i < kRates.size(); ++i)
    run_body(at_rate(kRates[i], insertion, options, device, hand),
             [rate = kRates[i], &held = forces[i]](const NeedleRow& row) {
               hold_at_10khz(axial(row), rate, held);
             });
  return {rms_difference(forces[2], forces[0]), rms_difference(forces[2], forces[1])};
}

void add_row(const std::string& insertion, const DeviceLimits& device, const std::string& hand,
             const Shares& off, Experiment& out) {
  std::string name = insertion;  // a cell of the table holds no comma
  name.erase(std::remove(name.begin(), name.end(), ','), name.end());
  out.tables.front().second.rows.push_back(
      {name, std::string(device.name), hand, to_csv(off[0]), to_csv(off[1])});
}

void claim_shares(const ClaimBasis& basis, const std::string& insertion, const DeviceLimits& device,
                  const std::string& hand, const Shares& off, Experiment& out) {
  for (std::size_t i = 0; i < off.size(); ++i) {
    std::string text = insertion + ": total axial force at " + to_csv(kRates[i]);
    text.append(" Hz against 10 kHz, ").append(device.name).append(", ").append(hand);
    out.claims.push_back(claim_at_most(basis, text.append(", RMS share"), off[i], 0.02, ""));
  }
}

Shares together(const std::vector<Shares>& all) {
  Shares sum{};
  for (const Shares& off : all) {
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] += off[k] * off[k] / static_cast<double>(all.size());
  }
  for (double& share : sum) share = std::sqrt(share);
  return sum;
}

std::vector<DeviceLimits> compared_devices(const ExperimentOptions& options) {
  if (!options.devices.empty()) return options.devices;
  const auto all = device_table();
  return {all.begin(), all.end()};
}

// One insertion on all devices: without tremor, then the tremors and all of them together.
void compare_rates(const Insertion& insertion, const ExperimentOptions& options, Experiment& out) {
  for (const DeviceLimits& device : compared_devices(options)) {
    HandParams hand;
    hand.tremor_rms = 0;
    const Shares calm = differences(insertion, options, device, hand);
    add_row(insertion.name, device, "no tremor", calm, out);
    claim_shares(insertion.basis, insertion.name, device, "no tremor", calm, out);
    hand = HandParams{};
    std::vector<Shares> tremors;
    for (std::uint64_t i = 0; i < kTremorSeeds; ++i) {
      hand.seed = options.seed + i;
      tremors.push_back(differences(insertion, options, device, hand));
      add_row(insertion.name, device, "tremor " + std::to_string(hand.seed), tremors.back(), out);
    }
    const std::string all = std::to_string(kTremorSeeds) + " tremors together";
    add_row(insertion.name, device, all, together(tremors), out);
    claim_shares(insertion.basis, insertion.name, device, all, together(tremors), out);
  }
}

// Bodies, speeds and hands that nobody chose, from draws that none had seen when the last
// parameter was set.
void compare_rates_on_drawn_bodies(const ExperimentOptions& options, Experiment& out) {
  constexpr std::uint64_t kBodies = 8;
  const std::uint64_t draw = mix_bits(options.seed);
  for (const DeviceLimits& device : compared_devices(options)) {
    std::vector<Shares> bodies;
    for (std::uint64_t i = 0; i < kBodies; ++i) {
      const Insertion insertion = draw_insertion(draw, i);
      HandParams hand;
      hand.seed = draw + i;
      bodies.push_back(differences(insertion, options, device, hand));
      add_row(insertion.name, device, "tremor of its own", bodies.back(), out);
    }
    const std::string hands = "bodies and tremors together";
    const std::string all = std::to_string(kBodies) + " drawn bodies";
    add_row(all, device, hands, together(bodies), out);
    claim_shares(ClaimKind::independent, all, device, hands, together(bodies), out);
  }
}

// The first insertion at each rate without tremor: traces and plot.
void show_rates(const Insertion& insertion, const ExperimentOptions& options,
                const DeviceLimits& device, Experiment& out) {
  Plot plot{out.title,
            {{"time (s)", "axial force (N), no tremor", {}},
             {"time (s)", "force less that at 10 kHz (N)", {}},
             {"time (s)", "depth (mm)", {}}}};
  HandParams calm;
  calm.tremor_rms = 0;
  for (const double rate : kRates) {
    ExperimentTrace trace{to_csv(rate) + "hz",
                          run_body(at_rate(rate, insertion, options, device, calm)),
                          region_names(table_layer_names())};
    const std::string label = to_csv(rate / 1000) + " kHz";
    plot.panels[0].series.push_back(plot_rows(trace.rows, label, axial));
    plot.panels[2].series.push_back(
        plot_rows(trace.rows, label, [](const NeedleRow& r) { return r.depth / kMillimetre; }));
    out.traces.push_back(std::move(trace));
  }
  const auto fastest = held_at_10khz(out.traces.back().rows, kRates.back());
  for (std::size_t i = 0; i + 1 < kRates.size(); ++i) {
    const auto held = held_at_10khz(out.traces[i].rows, kRates[i]);
    PlotSeries off{to_csv(kRates[i] / 1000) + " kHz", {}, {}};
    for (std::size_t k = 0; k < std::min(held.size(), fastest.size()); k += 5) {
      off.x.push_back(static_cast<double>(k) / kRates.back());
      off.y.push_back(held[k] - fastest[k]);
    }
    plot.panels[1].series.push_back(std::move(off));
  }
  out.plots = {{"", std::move(plot)}};
}

}  // namespace

std::vector<std::string> table_layer_names() {
  return {"skin", "muscle", "bursa", "tendon", "cartilage", "bone"};
}

Experiment run_insertions_at_rates(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out;
  out.title = "Insertions with all laws at 1, 2 and 10 kHz";
  out.source =
      "[Alamilla2020] conclusions: the number of iterations has to be set for each device; no "
      "figure";
  out.tables = {
      {"",
       {{"insertion", "device", "hand", "rms_share_1_khz_to_10_khz", "rms_share_2_khz_to_10_khz"},
        {}}}};
  const std::vector<Insertion> all = insertions();
  show_rates(all.front(), options, device, out);
  for (const Insertion& insertion : all) compare_rates(insertion, options, out);
  compare_rates_on_drawn_bodies(options, out);
  out.assumed = assumed_with_hand(
      {"bodies and speeds; of all tissues clamping 200 N/m and a quarter of the force on the way "
       "out",
       "2 %, below which rates count as one feel"});
  return out;
}

Experiment run_rates(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out = run_insertions_at_rates(options, device);
  compare_rates_under_sway(options, out);
  return out;
}

}  // namespace artus
