// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/aperture_coupling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "artus/detail/core/noise.h"
#include "artus/detail/echo/acquire/point_echo.h"
#include "artus/detail/echo/probe/gain_ramp.h"

namespace artus {
namespace {

constexpr std::size_t kCouplingStride = 16;  // samples between exact values of the gain
// A lens in air, assumed: as scanners show it, some bands that are grey and gone at 1 cm.
constexpr double kLensPitch = 1.2e-3;  // m from one repeat to the next
constexpr int kRepeats = 8;
constexpr double kFirstRepeat = 0.05;    // of what the face itself rings
constexpr double kRepeatDecay = 0.5;     // from one to the next
constexpr double kRepeatSpread = 60e-6;  // m that each is longer than the one before
constexpr double kUneven = 0.6;          // between elements, of amplitude
constexpr int kUnevenLines = 5;          // scanlines over which that changes

/// What of a repeat the elements under a scanline make.
double evenness(int l, int repeat) {
  const auto seed = static_cast<std::uint64_t>(repeat);
  const auto cell = static_cast<std::uint64_t>(l / kUnevenLines);
  const double t = static_cast<double>(l % kUnevenLines) / kUnevenLines;
  return 1 - kUneven * ((1 - t) * uniform_noise(seed, cell) + t * uniform_noise(seed, cell + 1));
}

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

/// Each repeat of the lens is weaker than the last, longer, as what is high in it is lost first,
/// and seen by all of the aperture that is in use at its depth.
void ApertureCoupling::add_ringing(int l, bool touches, double sample_depth,
                                   std::span<float> re) const noexcept {
  if (touches && complete_) return;
  add_point_echo(1, touches ? 1 - at_line(l) : 1, re);
  double amplitude = kFirstRepeat;
  for (int k = 1; k <= kRepeats; ++k, amplitude *= kRepeatDecay) {
    const double depth = k * kLensPitch;
    const double dry = touches ? 1 - std::sqrt(gain(l, depth)) : 1;
    if (!(dry > 0)) continue;
    const double share = amplitude * dry * evenness(l, k) / (k + 1);
    for (int i = 0; i <= k; ++i)
      add_point_echo(1 + (depth + (i - 0.5 * k) * kRepeatSpread) / sample_depth, share, re);
  }
}

}  // namespace artus
