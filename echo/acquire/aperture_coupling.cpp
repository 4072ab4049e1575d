// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/aperture_coupling.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/echo/acquire/point_echo.h"
#include "artus/detail/echo/probe/gain_ramp.h"

namespace artus {
namespace {

constexpr std::size_t kCouplingStride = 16;  // samples between exact values of the gain
constexpr double kAirPitch = 1.2e-3;  // m. assumed: lens thickness, pitch of lines without contact
constexpr int kAirLines = 9;
constexpr double kAirDecay = 0.45;  // assumed

double clean(float coupling) {
  return coupling > 0 ? std::min(1.0, static_cast<double>(coupling)) : 0.0;
}

}  // namespace

void ApertureCoupling::set(std::span<const float> coupling) {
  complete_ = std::all_of(coupling.begin(), coupling.end(), [](float c) { return c >= 1; });
  if (complete_) return;
  sum_.assign(1, 0.0);
  for (const float c : coupling) sum_.push_back(sum_.back() + clean(c));
}

/// Where a scanline leaves the face, in strips from the -x edge.
double ApertureCoupling::place_of(int l) const noexcept {
  const auto strips = static_cast<double>(sum_.size() - 1);
  return transducer_.n_lines > 1 ? strips * l / (transducer_.n_lines - 1) : strips / 2;
}

/// The coupling summed up from the -x edge to `place` (strips).
double ApertureCoupling::integral(double place) const noexcept {
  const auto i = std::min(static_cast<std::size_t>(place), sum_.size() - 2);
  return sum_[i] + (place - static_cast<double>(i)) * (sum_[i + 1] - sum_[i]);
}

double ApertureCoupling::at_line(int l) const noexcept {
  if (complete_) return 1;
  const auto i = std::min(static_cast<std::size_t>(place_of(l)), sum_.size() - 2);
  return sum_[i + 1] - sum_[i];
}

double ApertureCoupling::gain(int l, double z) const noexcept {
  if (complete_) return 1;
  const auto strips = static_cast<double>(sum_.size() - 1);
  const double aperture = std::min(z / transducer_.f_number, transducer_.max_aperture);
  const double half = std::max(0.5 * aperture / transducer_.width * strips, 0.01);
  const double low = std::max(0.0, place_of(l) - half);
  const double high = std::min(strips, place_of(l) + half);
  const double share = (integral(high) - integral(low)) / (high - low);
  return share * share;
}

void ApertureCoupling::apply(int l, double sample_depth, EchoSpan line) const noexcept {
  if (complete_) return;
  apply_ramp<double>(
      {0, line.size(), kCouplingStride},
      [&](std::size_t sample) { return gain(l, static_cast<double>(sample) * sample_depth); },
      [&](std::size_t i, float g) { scale_sample(line, i, g); });
}

void add_lens_ringing(double share, double sample_depth, std::span<float> re) noexcept {
  double amplitude = share;
  for (int k = 0; k < kAirLines && amplitude > 0; ++k) {
    add_point_echo(1 + k * kAirPitch / sample_depth, amplitude, re);
    amplitude *= kAirDecay;
  }
}

}  // namespace artus
