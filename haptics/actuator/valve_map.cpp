// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/valve_map.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/haptics/actuator/servovalve.h"

namespace artus {
namespace {

/// How much denser the samples are at the centre than at the ends; assumed: resolves the leakage.
constexpr double kDensity = 4;
/// Samples below the exhaust's and above the supply's pressure.
constexpr std::size_t kBeyondEnds = 24;

}  // namespace

ValveMap::ValveMap(const ServovalveParams& valve, const CylinderParams& cylinder)
    : stroke_(cylinder.stroke),
      // Exhaust and supply are samples themselves: the flow has its kinks there.
      step_((valve.supply - valve.exhaust) / static_cast<double>(kPressures - 1 - 2 * kBeyondEnds)),
      flows_(kOpenings * kPressures) {
  low_ = valve.exhaust - step_ * static_cast<double>(kBeyondEnds);
  const std::size_t centre = kOpenings / 2;
  for (std::size_t i = 0; i <= centre; ++i) {
    // Exactly symmetric, with exact ends.
    const double share = static_cast<double>(i) / static_cast<double>(centre);
    openings_[centre + i] = i == centre ? 1 : std::sinh(kDensity * share) / std::sinh(kDensity);
    openings_[centre - i] = -openings_[centre + i];
  }
  for (std::size_t i = 0; i < kOpenings; ++i) {
    for (std::size_t j = 0; j < kPressures; ++j) {
      const double p = low_ + step_ * static_cast<double>(j);
      flows_[i * kPressures + j] = port_flow(valve, openings_[i], p, cylinder.temperature);
    }
  }
}

ValveMap::PressureBracket ValveMap::bracket(double p) const noexcept {
  const double s = std::clamp((p - low_) / step_, 0.0, static_cast<double>(kPressures - 1));
  PressureBracket b;
  b.index = std::min(static_cast<std::size_t>(s), kPressures - 2);
  b.weight = s - static_cast<double>(b.index);
  return b;
}

double ValveMap::at(std::size_t i, const PressureBracket& b) const noexcept {
  const double* row = &flows_[i * kPressures + b.index];
  return row[0] + b.weight * (row[1] - row[0]);
}

template <class F>
double ValveMap::invert(double q, F value_at) const noexcept {
  std::size_t low = 0;
  std::size_t high = kOpenings - 1;
  if (!(q > value_at(low))) return openings_[low];
  if (!(q < value_at(high))) return openings_[high];
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (value_at(middle) <= q ? low : high) = middle;
  }
  const double below = value_at(low);
  const double above = value_at(high);
  return openings_[low] + (openings_[high] - openings_[low]) * (q - below) / (above - below);
}

template <class F>
double ValveMap::interpolate(double opening, F value_at) const noexcept {
  const double x = std::clamp(opening, -1.0, 1.0);
  const auto above = std::upper_bound(openings_.begin() + 1, openings_.end() - 1, x);
  const auto i = static_cast<std::size_t>(above - openings_.begin());
  const double w = (x - openings_[i - 1]) / (openings_[i] - openings_[i - 1]);
  return (1 - w) * value_at(i - 1) + w * value_at(i);
}

double ValveMap::flow(double opening, double p) const noexcept {
  const PressureBracket b = bracket(p);
  return interpolate(opening, [&](std::size_t i) { return at(i, b); });
}

double ValveMap::find_opening(double q, double p) const noexcept {
  const PressureBracket b = bracket(p);
  return invert(q, [&](std::size_t i) { return at(i, b); });
}

double ValveMap::active_flow(double opening, double p_P, double p_N, double y) const noexcept {
  const double length_p = stroke_ / 2 + y;
  const double length_n = stroke_ / 2 - y;
  return stroke_ / 2 * (flow(opening, p_P) / length_p - flow(-opening, p_N) / length_n);
}

double ValveMap::find_active_opening(double q_A, double p_P, double p_N, double y) const noexcept {
  const PressureBracket b_P = bracket(p_P);
  const PressureBracket b_N = bracket(p_N);
  const double share_P = stroke_ / 2 / (stroke_ / 2 + y);
  const double share_N = stroke_ / 2 / (stroke_ / 2 - y);
  // The samples lie symmetrically about the centre, so -opening is the mirrored index.
  return invert(q_A, [&](std::size_t i) {
    return share_P * at(i, b_P) - share_N * at(kOpenings - 1 - i, b_N);
  });
}

}  // namespace artus
