// SPDX-License-Identifier: AGPL-3.0-or-later
// What velocity estimators cost: noise and lag.
#include <cmath>
#include <memory>
#include <utility>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/needle/experiments.h"
#include "artus/detail/haptics/needle/laws/velocity_estimator.h"

namespace artus {
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

using NamedEstimator = std::pair<std::string, std::unique_ptr<VelocityEstimator>>;

std::vector<NamedEstimator> make_estimators(double dt) {
  std::vector<NamedEstimator> all;
  all.emplace_back("difference 1 tick", std::make_unique<WindowedDifference>(dt, dt));
  all.emplace_back("difference 10 ms", std::make_unique<WindowedDifference>(0.01, dt));
  all.emplace_back("Taylor order 1 5 ms", std::make_unique<TaylorEstimator>(1, 0.005, dt));
  all.emplace_back("Taylor order 2 5 ms", std::make_unique<TaylorEstimator>(2, 0.005, dt));
  all.emplace_back("Taylor order 3 5 ms", std::make_unique<TaylorEstimator>(3, 0.005, dt));
  all.emplace_back("Levant 1 m/s2", std::make_unique<LevantDifferentiator>(1, dt));
  all.emplace_back("Levant 10 m/s2", std::make_unique<LevantDifferentiator>(10, dt));
  return all;
}

}  // namespace

Experiment run_velocity_estimators(const ExperimentOptions& /*options*/,
                                   const DeviceLimits& /*device*/) {
  Experiment out;
  out.title = "Velocity estimators on a 1 Hz, 10 mm sine: noise and lag by encoder step and rate";
  out.source = "[Alamilla2020] section 2.1.2, which names them without figures";
  TextTable table{{"estimator", "rate_hz", "encoder_um", "noise_mm_s", "lag_ms"}, {}};
  std::vector<PlotPanel> panels;
  EstimatorResult raw;
  EstimatorResult window;
  for (const double rate : {1000.0, 10000.0}) {
    std::vector<PlotSeries> clouds;
    for (const double encoder : {10e-6, 55e-6}) {
      const auto all = make_estimators(1 / rate);
      for (std::size_t k = 0; k < all.size(); ++k) {
        const std::string& label = all[k].first;
        if (clouds.size() <= k) clouds.push_back({label, {}, {}, PlotStyle::points});
        const EstimatorResult r = rate_estimator(*all[k].second, rate, encoder);
        table.rows.push_back({label, to_csv(rate), to_csv(encoder * 1e6),
                              to_csv(r.noise / kMillimetre), to_csv(r.lag * 1e3)});
        clouds[k].x.push_back(r.lag * 1e3);
        clouds[k].y.push_back(r.noise / kMillimetre);
        if (rate != 1000 || encoder != 55e-6) continue;
        if (label == "difference 1 tick") raw = r;
        if (label == "difference 10 ms") window = r;
      }
    }
    panels.push_back({"lag (ms) at " + to_csv(rate / 1000) +
                          " kHz; the quieter of each pair: encoder step 10 um, the other 55 um",
                      "noise (mm/s)", std::move(clouds), true});
  }
  out.claims = {
      claim_near({ClaimKind::input, "half the window"}, "lag of a 10 ms difference",
                 window.lag * 1e3, 5, 0.05, "ms"),
      claim_at_most({ClaimKind::input, "a tenth, by the window's length"},
                    "its noise over that of a 1 ms difference", window.noise / raw.noise, 0.2, "")};
  out.assumed = {"the sine, the encoder steps, the estimators' windows and bounds"};
  out.tables = {{"", std::move(table)}};
  out.plots = {{"", {out.title, std::move(panels)}}};
  return out;
}

}  // namespace artus
