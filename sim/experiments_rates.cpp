// SPDX-License-Identifier: AGPL-3.0-or-later
// What must not depend on the loop's rate, what velocity estimators cost, what a hand can tell.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/units.h"
#include "haptics/velocity_estimator.h"
#include "sim/experiment_list.h"

namespace artus {
namespace {

constexpr double kTwoPi = 6.283185307179586;

// Skin, muscle, bursa, tendon, cartilage, bone with all laws on.
std::vector<LayerHaptics> table_layers() {
  const std::array<double, 5> forces{1, 2, 1.5, 2.5, 3};
  std::vector<LayerHaptics> layers;
  for (const double f : forces) {
    layers.push_back(plain_layer(f, 500, 0.25 * f));
    layers.back().tissue.friction = 1;
    layers.back().tissue.clamping_stiffness = 200;
  }
  layers[0].tissue.wall_stiffness = 1500;
  layers[0].tissue.puncture_force = 1.5;
  layers[2].tissue.puncture_force = 2;
  layers.push_back(bone_layer(4, 4000));
  return layers;
}

double axial(const NeedleRow& r) {
  return r.forces.total.force.dot(r.axis);
}

// The trace's value at each millisecond.
std::vector<double> at_1khz(const std::vector<NeedleRow>& rows, double rate) {
  std::vector<double> out;
  const auto stride = static_cast<std::size_t>(std::lround(rate / 1000));
  for (std::size_t i = 0; i < rows.size(); i += stride) out.push_back(axial(rows[i]));
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

}  // namespace

Experiment run_rates(const ExperimentOptions& options, const DeviceLimits& device) {
  Experiment out;
  out.title = "One insertion with all laws at 1, 2 and 10 kHz, hand without tremor";
  out.plot.title = out.title;
  out.plot.panels = {{"time (s)", "axial force (N)", {}}, {"time (s)", "depth (mm)", {}}};
  out.table.header = {"rate_hz", "rms_difference_to_10_khz"};
  std::array<std::vector<double>, 3> forces;
  const std::array<double, 3> rates{1000, 2000, 10000};
  for (std::size_t i = 0; i < rates.size(); ++i) {
    BodyExperiment e;
    e.body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(),
                                      {0, 0.004, 0.018, 0.021, 0.027, 0.030});
    e.layers = table_layers();
    e.device = device;
    e.hand.seed = options.seed;
    e.hand.tremor_rms = 0;  // when a trembling needle counts as still hangs on single samples
    e.rate_hz = rates[i];
    e.phases = {stay(0.3), push_to(0.0305, 0.015), stay(0.7), pull_to(-0.004, 0.02)};
    ExperimentTrace trace{to_csv(rates[i]) + "hz", run_body(e), layer_names(6)};
    forces[i] = at_1khz(trace.rows, rates[i]);
    out.plot.panels[0].series.push_back(plot_rows(trace.rows, trace.label, axial));
    out.plot.panels[1].series.push_back(plot_rows(
        trace.rows, trace.label, [](const NeedleRow& r) { return r.depth / kMillimetre; }));
    out.traces.push_back(std::move(trace));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const double off = rms_difference(forces[2], forces[i]);
    out.table.rows.push_back({to_csv(rates[i]), to_csv(off)});
    out.claims.push_back(
        claim_at_most("total axial force at " + to_csv(rates[i]) + " Hz against 10 kHz, RMS share",
                      off, 0.02, ""));
  }
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
  out.table.header = {"estimator", "rate_hz", "encoder_um", "noise_mm_s", "lag_ms"};
  PlotSeries cloud{"estimator x encoder x rate", {}, {}, "points pt 7"};
  double window_lag = 0;
  double raw_noise = 0;
  double window_noise = 0;
  for (const double rate : {1000.0, 10000.0}) {
    const double dt = 1 / rate;
    for (const double encoder : {10e-6, 55e-6}) {
      std::vector<std::pair<std::string, std::unique_ptr<VelocityEstimator>>> all;
      all.emplace_back("difference 1 tick", std::make_unique<WindowedDifference>(dt, dt));
      all.emplace_back("difference 10 ms", std::make_unique<WindowedDifference>(0.01, dt));
      all.emplace_back("Taylor order 1 5 ms", std::make_unique<TaylorEstimator>(1, 0.005, dt));
      all.emplace_back("Taylor order 2 5 ms", std::make_unique<TaylorEstimator>(2, 0.005, dt));
      all.emplace_back("Taylor order 3 5 ms", std::make_unique<TaylorEstimator>(3, 0.005, dt));
      all.emplace_back("Levant 1 m/s2", std::make_unique<LevantDifferentiator>(1, dt));
      all.emplace_back("Levant 10 m/s2", std::make_unique<LevantDifferentiator>(10, dt));
      for (auto& [label, estimator] : all) {
        const EstimatorResult r = rate_estimator(*estimator, rate, encoder);
        out.table.rows.push_back({label, to_csv(rate), to_csv(encoder * 1e6),
                                  to_csv(r.noise / kMillimetre), to_csv(r.lag * 1e3)});
        cloud.x.push_back(r.lag * 1e3);
        cloud.y.push_back(r.noise / kMillimetre);
        if (rate != 1000 || encoder != 55e-6) continue;
        if (label == "difference 1 tick") raw_noise = r.noise;
        if (label != "difference 10 ms") continue;
        window_noise = r.noise;
        window_lag = r.lag;
      }
    }
  }
  out.claims = {
      claim_near("lag of a 10 ms difference", window_lag * 1e3, 5, 0.05, "ms"),
      claim_at_most("its noise over that of a 1 ms difference", window_noise / raw_noise, 0.2, "")};
  out.plot.title = out.title;
  out.plot.panels = {{"lag (ms)", "noise (mm/s)", {cloud}}};
  return out;
}

Experiment run_layer_changes(const ExperimentOptions& /*options*/, const DeviceLimits& /*device*/) {
  struct Layer {
    const char* name;
    double force;
    double stiffness;
  };
  // Table 4.2 of the source; K_t of the bundled tissue library.
  constexpr std::array<Layer, 6> kLayers{{{"skin", 1, 1500},
                                          {"muscle", 2, 500},
                                          {"bursa", 1.5, 500},
                                          {"tendon", 2.5, 500},
                                          {"cartilage", 3, 500},
                                          {"bone", 4, 4000}}};
  constexpr double kJnd = 0.07;  // share of the force, [Pang1991]
  Experiment out;
  out.title = "Layer changes of table 4.2 against a just-noticeable difference of 7 % of the force";
  out.table.header = {"from", "to", "step_n", "step_share", "rise_mm", "jnd_multiples"};
  PlotSeries steps{"pair of layers", {}, {}, "points pt 7"};
  double least = 1e9;
  for (const Layer& from : kLayers) {
    for (const Layer& to : kLayers) {
      if (from.force == to.force) continue;
      const double step = to.force - from.force;
      const double share = std::abs(step) / from.force;
      const double rise = step > 0 ? step / to.stiffness : 0;  // a fall is at once
      out.table.rows.push_back({from.name, to.name, to_csv(step), to_csv(share),
                                to_csv(rise / kMillimetre), to_csv(share / kJnd)});
      steps.x.push_back(rise / kMillimetre);
      steps.y.push_back(share / kJnd);
      least = std::min(least, share / kJnd);
    }
  }
  out.claims = {claim_at_least("the smallest step, in just-noticeable differences", least, 1, "")};
  out.plot.title = out.title;
  out.plot.panels = {{"rise distance (mm)", "force step (JND)", {steps}}};
  return out;
}

}  // namespace artus
