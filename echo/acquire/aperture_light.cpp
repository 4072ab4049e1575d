// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/aperture_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "artus/detail/echo/probe/gain_ramp.h"

namespace artus {
namespace {

constexpr double kHeardBeside = 0.25;  // of the aperture, to either side of a line. assumed
constexpr double kMostRaised = 2;      // beyond 6 dB other planes already carry the echo. assumed
constexpr double kUnheard = 1.03;      // gains up to this are not worth applying
constexpr int kEvery = 2;              // lines between those that are asked
constexpr float kEnded = -1;

}  // namespace

ApertureLight::ApertureLight(const Transducer& transducer, double depth, int n_samples)
    : n_lines_(transducer.n_lines),
      pitch_(transducer.pitch()),
      f_number_(transducer.f_number),
      max_aperture_(transducer.max_aperture),
      step_(depth / (kNodes - 1)),
      stride_(static_cast<std::size_t>((n_samples + kNodes - 2) / (kNodes - 1))),
      arrives_(static_cast<std::size_t>(n_lines_) * kNodes, kEnded) {}

void ApertureLight::note(int line, const BeamTrace& trace) noexcept {
  float* arrives = arrives_.data() + static_cast<std::ptrdiff_t>(line) * kNodes;
  std::fill_n(arrives, kNodes, kEnded);
  if (!trace.contact) return;
  std::size_t i = 0;
  for (int k = 0; k < kNodes; ++k) {
    const double sample = static_cast<double>(k) * static_cast<double>(stride_);
    while (i < trace.n_runs && trace.runs[i].end <= sample) ++i;
    if (i == trace.n_runs) return;
    const BeamRun& run = trace.runs[i];
    const double into = std::clamp((sample - run.begin) / (run.end - run.begin), 0.0, 1.0);
    arrives[k] = static_cast<float>(
        std::exp(run.log_gain_begin + into * (run.log_gain_end - run.log_gain_begin)));
  }
}

double ApertureLight::gain(int line, int node) const noexcept {
  const double z = node * step_;
  const double beside = kHeardBeside * std::min(z / f_number_, max_aperture_);
  const int reach = static_cast<int>(beside / pitch_);
  const auto at = [&](int l) {
    return arrives_[static_cast<std::size_t>(l) * kNodes + static_cast<std::size_t>(node)];
  };
  const float own = at(line);
  if (reach == 0 || own <= 0) return 1;
  double sum = 0;
  double weights = 0;
  for (int k = -reach; k <= reach; k += kEvery) {
    const int l = line + k;
    if (l < 0 || l >= n_lines_ || at(l) < 0) continue;
    const double weight = 1 - std::abs(k) / (reach + 1.0);
    sum += weight * static_cast<double>(at(l));
    weights += weight;
  }
  if (weights <= 0) return 1;  // every line that is asked has ended
  return std::clamp(sum / weights / static_cast<double>(own), 1.0, kMostRaised);
}

void ApertureLight::apply(int line, EchoSpan echoes) const noexcept {
  std::array<double, kNodes> gains{};
  for (int k = 0; k < kNodes; ++k) gains[static_cast<std::size_t>(k)] = gain(line, k);
  if (*std::max_element(gains.begin(), gains.end()) < kUnheard) return;
  apply_ramp<float>(
      {0, std::min(echoes.size(), (kNodes - 1) * stride_), stride_,
       std::numeric_limits<double>::infinity()},
      [&](std::size_t sample) { return gains[sample / stride_]; },
      [&](std::size_t i, float g) { scale_sample(echoes, i, g); });
}

}  // namespace artus
