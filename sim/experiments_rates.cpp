// SPDX-License-Identifier: AGPL-3.0-or-later
// What must not depend on the loop's rate, what velocity estimators cost, what a hand can tell.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>

#include "core/units.h"
#include "haptics/velocity_estimator.h"
#include "sim/experiment_list.h"

namespace artus {
namespace {

constexpr double kTwoPi = 6.283185307179586;

// A body with all laws on, a hard last layer where bone is, and what the hand means: in, a rest of
// 0.8 s, out. Of time alone, so that the hand is the same at every rate.
struct Insertion {
  const char* name;
  std::vector<double> begins;     // m
  std::vector<double> forces;     // N
  std::vector<double> stiffness;  // N/m
  std::vector<double> membranes;  // N, 0: none
  bool bone;                      // whether the last layer is
  double to;                      // m; the tissue holds the tip back by some millimetres
  double in;                      // m/s
  double out;                     // m/s
};

constexpr double kFrom = -0.005;  // m
constexpr double kStart = 0.3;    // s

// The friction's limits were chosen on the first, the others were held out from that.
std::vector<Insertion> insertions() {
  return {{"table 4.2, 15 mm/s onto bone",
           {0, 0.004, 0.018, 0.021, 0.027, 0.030},
           {1, 2, 1.5, 2.5, 3, 4},
           {1500, 500, 500, 500, 500, 4000},
           {1.5, 0, 2, 0, 0, 0},
           true,
           0.0335,
           0.015,
           0.020},
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
           0.040},
          {"two membranes, 45 mm/s onto bone",
           {0, 0.003, 0.014, 0.019, 0.026},
           {1, 2, 1.5, 2.5, 4},
           {1500, 500, 400, 600, 4000},
           {1.5, 0, 1.8, 0, 0},
           true,
           0.029,
           0.045,
           0.045}};
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
std::vector<double> held_at_10khz(const std::vector<NeedleRow>& rows, double rate) {
  std::vector<double> out;
  const auto times = static_cast<std::size_t>(std::lround(10000 / rate));
  for (const NeedleRow& row : rows) out.insert(out.end(), times, axial(row));
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

std::vector<NeedleRow> run_at(double rate, const Insertion& insertion, const ExperimentLaws& laws,
                              const DeviceLimits& device, const HandParams& hand) {
  constexpr double kAfter = 0.35;  // s outside
  BodyExperiment e;
  e.body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), insertion.begins);
  e.layers = layers_of(insertion);
  e.names = table_layer_names();
  e.laws = laws;
  e.device = device;
  e.hand = hand;
  e.rate_hz = rate;
  e.path = [&insertion](double t) {
    return in_and_out(insertion, t);
  };
  e.path_duration = time_back(insertion) + (insertion.to - kFrom) / insertion.out + kAfter;
  return run_body(e);
}

// RMS share of the difference to 10 kHz, at 1 and at 2 kHz.
std::array<double, 2> differences(const Insertion& insertion, const ExperimentLaws& laws,
                                  const DeviceLimits& device, const HandParams& hand) {
  std::array<std::vector<double>, kRates.size()> forces;
  for (std::size_t i = 0; i < kRates.size(); ++i)
    forces[i] = held_at_10khz(run_at(kRates[i], insertion, laws, device, hand), kRates[i]);
  return {rms_difference(forces[2], forces[0]), rms_difference(forces[2], forces[1])};
}

// One insertion on all devices: without tremor, then the tremors and all of them together.
void compare_rates(const Insertion& insertion, const ExperimentOptions& options, Experiment& out) {
  const auto add = [&out, &insertion](const DeviceLimits& d, const std::string& hand,
                                      const std::array<double, 2>& off) {
    // A cell of the table holds no comma.
    std::string name = insertion.name;
    name.erase(std::remove(name.begin(), name.end(), ','), name.end());
    out.table.rows.push_back({name, std::string(d.name), hand, to_csv(off[0]), to_csv(off[1])});
  };
  const auto claim = [&out, &insertion](const std::string& hand, const std::array<double, 2>& off) {
    for (std::size_t i = 0; i < off.size(); ++i) {
      std::string text = insertion.name;
      text.append(": total axial force at ").append(to_csv(kRates[i]));
      text.append(" Hz against 10 kHz, ").append(hand).append(", RMS share");
      out.claims.push_back(claim_at_most(std::move(text), off[i], 0.02, ""));
    }
  };
  for (const DeviceLimits& device : device_table()) {
    const std::string name(device.name);
    HandParams hand;
    hand.tremor_rms = 0;
    const auto calm = differences(insertion, options.laws, device, hand);
    add(device, "no tremor", calm);
    claim(name + ", no tremor", calm);
    hand = HandParams{};
    std::array<double, 2> together{};
    for (std::uint64_t i = 0; i < kTremorSeeds; ++i) {
      hand.seed = options.seed + i;
      const auto off = differences(insertion, options.laws, device, hand);
      add(device, "tremor " + std::to_string(hand.seed), off);
      for (std::size_t k = 0; k < off.size(); ++k) together[k] += off[k] * off[k] / kTremorSeeds;
    }
    for (double& share : together) share = std::sqrt(share);
    const std::string all = std::to_string(kTremorSeeds) + " tremors together";
    add(device, all, together);
    std::string hands = name;
    claim(hands.append(", ").append(all), together);
  }
}

}  // namespace

std::vector<std::string> table_layer_names() {
  return {"skin", "muscle", "bursa", "tendon", "cartilage", "bone"};
}

Experiment run_rates(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out;
  out.title = "Insertions with all laws at 1, 2 and 10 kHz";
  out.source =
      "[Alamilla2020] conclusions: the number of iterations has to be set for each device; no "
      "figure";
  out.plot.title = out.title;
  out.plot.panels = {{"time (s)", "axial force (N), no tremor", {}},
                     {"time (s)", "force less that at 10 kHz (N)", {}},
                     {"time (s)", "depth (mm)", {}}};
  out.table.header = {"insertion", "device", "hand", "rms_share_1_khz_to_10_khz",
                      "rms_share_2_khz_to_10_khz"};
  const std::vector<Insertion> all = insertions();
  HandParams calm;
  calm.tremor_rms = 0;
  for (const double rate : kRates) {
    ExperimentTrace trace{to_csv(rate) + "hz",
                          run_at(rate, all.front(), options.laws, device, calm),
                          region_names(table_layer_names())};
    const std::string label = to_csv(rate / 1000) + " kHz";
    out.plot.panels[0].series.push_back(plot_rows(trace.rows, label, axial));
    out.plot.panels[2].series.push_back(
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
    out.plot.panels[1].series.push_back(std::move(off));
  }
  for (const Insertion& insertion : all) compare_rates(insertion, options, out);
  return out;
}

namespace {

struct EstimatorResult {
  double noise = 0;  // m/s, rms off the best sine
  double lag = 0;    // s
};

// Estimates a 1 Hz, 10 mm sine read through an encoder; fits the estimate's sine.
EstimatorResult rate_estimator(VelocityEstimator& estimator, double rate, double encoder) {
  constexpr double kAmplitude = 0.01;  // m
  constexpr int kSeconds = 4;
  const auto n = static_cast<std::size_t>(kSeconds * rate);
  estimator.reset(0);
  std::vector<double> v(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = kAmplitude * std::sin(kTwoPi * static_cast<double>(i) / rate);
    v[i] = estimator.step(std::round(x / encoder) * encoder);
  }
  double in_phase = 0;
  double quadrature = 0;
  const auto from = static_cast<std::size_t>(rate);  // after a second of settling
  const double count = static_cast<double>(n - from);
  for (std::size_t i = from; i < n; ++i) {
    const double t = static_cast<double>(i) / rate;
    in_phase += 2 / count * v[i] * std::cos(kTwoPi * t);
    quadrature += 2 / count * v[i] * std::sin(kTwoPi * t);
  }
  EstimatorResult result;
  result.lag = std::atan2(quadrature, in_phase) / kTwoPi;
  double square = 0;
  for (std::size_t i = from; i < n; ++i) {
    const double t = static_cast<double>(i) / rate;
    const double off = v[i] - in_phase * std::cos(kTwoPi * t) - quadrature * std::sin(kTwoPi * t);
    square += off * off;
  }
  result.noise = std::sqrt(square / count);
  return result;
}

}  // namespace

Experiment run_velocity_estimators(const ExperimentOptions& /*options*/,
                                   const DeviceLimits& /*device*/) {
  Experiment out;
  out.title = "Velocity estimators on a 1 Hz, 10 mm sine: noise and lag by encoder step and rate";
  out.source = "[Alamilla2020] section 2.1.2, which names them without figures";
  out.table.header = {"estimator", "rate_hz", "encoder_um", "noise_mm_s", "lag_ms"};
  std::vector<PlotPanel> panels;
  double window_lag = 0;
  double raw_noise = 0;
  double window_noise = 0;
  for (const double rate : {1000.0, 10000.0}) {
    const double dt = 1 / rate;
    std::vector<PlotSeries> clouds;
    for (const double encoder : {10e-6, 55e-6}) {
      std::vector<std::pair<std::string, std::unique_ptr<VelocityEstimator>>> all;
      all.emplace_back("difference 1 tick", std::make_unique<WindowedDifference>(dt, dt));
      all.emplace_back("difference 10 ms", std::make_unique<WindowedDifference>(0.01, dt));
      all.emplace_back("Taylor order 1 5 ms", std::make_unique<TaylorEstimator>(1, 0.005, dt));
      all.emplace_back("Taylor order 2 5 ms", std::make_unique<TaylorEstimator>(2, 0.005, dt));
      all.emplace_back("Taylor order 3 5 ms", std::make_unique<TaylorEstimator>(3, 0.005, dt));
      all.emplace_back("Levant 1 m/s2", std::make_unique<LevantDifferentiator>(1, dt));
      all.emplace_back("Levant 10 m/s2", std::make_unique<LevantDifferentiator>(10, dt));
      for (std::size_t k = 0; k < all.size(); ++k) {
        const std::string& label = all[k].first;
        auto& estimator = all[k].second;
        if (clouds.size() <= k)
          clouds.push_back({label, {}, {}, "points ps 1.5 pt " + std::to_string(k + 4)});
        const EstimatorResult r = rate_estimator(*estimator, rate, encoder);
        out.table.rows.push_back({label, to_csv(rate), to_csv(encoder * 1e6),
                                  to_csv(r.noise / kMillimetre), to_csv(r.lag * 1e3)});
        clouds[k].x.push_back(r.lag * 1e3);
        clouds[k].y.push_back(r.noise / kMillimetre);
        if (rate != 1000 || encoder != 55e-6) continue;
        if (label == "difference 1 tick") raw_noise = r.noise;
        if (label != "difference 10 ms") continue;
        window_noise = r.noise;
        window_lag = r.lag;
      }
    }
    panels.push_back({"lag (ms) at " + to_csv(rate / 1000) +
                          " kHz; the quieter of each pair: encoder step 10 um, the other 55 um",
                      "noise (mm/s)", std::move(clouds), true});
  }
  out.claims = {
      claim_near("lag of a 10 ms difference", window_lag * 1e3, 5, 0.05, "ms"),
      claim_at_most("its noise over that of a 1 ms difference", window_noise / raw_noise, 0.2, "")};
  out.plot.title = out.title;
  out.plot.panels = std::move(panels);
  return out;
}

namespace {

// Table 4.2 of the source; K_t of the bundled tissue library.
struct TableLayer {
  const char* name;
  double force;      // N
  double stiffness;  // N/m
};
constexpr std::array<TableLayer, 6> kTable{{{"skin", 1, 1500},
                                            {"muscle", 2, 500},
                                            {"bursa", 1.5, 500},
                                            {"tendon", 2.5, 500},
                                            {"cartilage", 3, 500},
                                            {"bone", 4, 4000}}};

struct Change {
  double before = 0;    // N, mean of the last millimetre before the change
  double after = 0;     // N, mean of what follows the rise
  double distance = 0;  // m, from the interface until nine tenths of the step are felt
};

// A needle pushed at 10 mm/s through 12 mm of one layer into another, as the hand feels it.
Change measure_change(const TableLayer& from, const TableLayer& to, const ExperimentLaws& laws,
                      const DeviceLimits& device) {
  constexpr double kInterface = 0.012;  // m
  constexpr double kBeyond = 0.009;     // m of the second layer; of a hard one as far as it lets
  const bool hard = std::string_view(to.name) == "bone";
  BodyExperiment e;
  e.body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, kInterface});
  e.layers = {plain_layer(from.force, from.stiffness),
              hard ? bone_layer(to.force, to.stiffness) : plain_layer(to.force, to.stiffness)};
  e.names = {from.name, to.name};
  e.laws = laws;
  e.device = device;
  e.hand.tremor_rms = 0;
  e.phases = {stay(0.1),
              push_to(hard ? kInterface + to.force / to.stiffness : kInterface + kBeyond, 0.01)};
  const std::vector<NeedleRow> rows = run_body(e);
  Change change;
  double count = 0;
  for (const NeedleRow& r : rows) {
    if (r.depth < kInterface - 1e-3 || r.depth >= kInterface) continue;
    change.before += resistance(r);
    ++count;
  }
  change.before /= std::max(count, 1.0);
  count = 0;
  for (const NeedleRow& r : rows) {
    if (r.depth < e.phases.back().depth - (hard ? 2e-5 : 1e-3)) continue;
    change.after += resistance(r);
    ++count;
  }
  change.after /= std::max(count, 1.0);
  const double step = change.after - change.before;
  for (const NeedleRow& r : rows) {
    if (r.depth < kInterface || (resistance(r) - change.before) / step < 0.9) continue;
    change.distance = r.depth - kInterface;
    break;
  }
  return change;
}

}  // namespace

Experiment run_layer_changes(const ExperimentOptions& options, const DeviceLimits& device) {
  constexpr double kJnd = 0.07;      // share of the force, [Pang1991] for 2.5 to 10 N
  constexpr double kWeakJnd = 0.14;  // assumed: twice that, for forces below 2.5 N
  Experiment out;
  out.title = "Layer changes of table 4.2, felt at 10 mm/s, in just-noticeable differences";
  out.source = "[Alamilla2020] table 4.2; [Pang1991] for the just-noticeable difference";
  out.table.header = {"from",
                      "to",
                      "before_n",
                      "after_n",
                      "step_n",
                      "step_share",
                      "rise_mm",
                      "jnd_multiples_at_7_percent",
                      "jnd_multiples_at_14_percent"};
  std::vector<PlotSeries> by_layer;
  for (std::size_t k = 0; k < kTable.size(); ++k)
    by_layer.push_back(
        {"to " + std::string(kTable[k].name), {}, {}, "points ps 1.5 pt " + std::to_string(k + 4)});
  std::array<double, kTable.size()> felt{};  // N on the plateau behind the change, of the last
  double least = 1e9;
  double off = 0;
  double longest = 0;
  for (const TableLayer& from : kTable) {
    if (std::string_view(from.name) == "bone") continue;  // nothing lies beyond it
    for (std::size_t k = 0; k < kTable.size(); ++k) {
      const TableLayer& to = kTable[k];
      if (from.force == to.force) continue;
      const Change c = measure_change(from, to, options.laws, device);
      const double step = c.after - c.before;
      const double share = std::abs(step) / c.before;
      out.table.rows.push_back({from.name, to.name, to_csv(c.before), to_csv(c.after), to_csv(step),
                                to_csv(share), to_csv(c.distance / kMillimetre),
                                to_csv(share / kJnd), to_csv(share / kWeakJnd)});
      PlotSeries& series = by_layer[k];
      series.x.push_back(c.distance / kMillimetre);
      series.y.push_back(share / kWeakJnd);
      felt[k] = c.after;
      least = std::min(least, share / kWeakJnd);
      longest = std::max(longest, c.distance / kMillimetre);
      off = std::max(off, std::abs(step / (to.force - from.force) - 1));
    }
  }
  out.claims = {
      claim_at_least("pairs of layers", static_cast<double>(out.table.rows.size()), 25, ""),
      claim_at_most("measured step off the table's, share of the step", off, 0.05, ""),
      claim_at_least("the smallest step in just-noticeable differences of 14 %", least, 1, ""),
      claim_at_most("the longest way until nine tenths of the step are felt", longest, 4.5, "mm")};
  for (std::size_t k = 0; k < kTable.size(); ++k)
    out.published.push_back(
        {kTable[k].name, to_csv(kTable[k].force) + " N", to_csv(felt[k]) + " N"});
  out.plot.title = out.title;
  by_layer.push_back({"noticed, 7 %", {0, longest}, {kJnd / kWeakJnd, kJnd / kWeakJnd}});
  by_layer.push_back({"noticed, 14 %", {0, longest}, {1, 1}});
  out.plot.panels = {
      {"distance until 90 % of the step (mm)", "force step (multiples of 14 %)", by_layer, true}};
  return out;
}

}  // namespace artus
