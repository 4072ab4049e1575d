// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/needle_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kSteelSpeed = 5800;                 // m/s
constexpr double kBoreSpeed = 1480;                  // m/s, water in the bore
constexpr double kSteelReflection = 0.933;           // -0.6 dB, muscle on steel
constexpr double kPlainSlopes = 5.7 * kDegree;       // rad, mean of a drawn shaft. assumed
constexpr double kEchogenicSlopes = 13.0 * kDegree;  // rad, of a dimpled one. assumed

/// dB over the mirror at an angle to the face; straight in between.
struct ScreenLevel {
  double degrees;
  double decibel;
};
constexpr std::array<ScreenLevel, 9> kPlainLevels{{{0, -7},
                                                   {5, -11},
                                                   {10, -17.5},
                                                   {15, -25.2},
                                                   {20, -28.8},
                                                   {30, -30.3},
                                                   {50, -32.8},
                                                   {75, -35},
                                                   {90, -38}}};
constexpr std::array<ScreenLevel, 3> kDimpledLevels{{{0, -7}, {10, -11}, {90, -22}}};

template <std::size_t N>
double level_at(const std::array<ScreenLevel, N>& levels, double degrees) noexcept {
  std::size_t k = 1;
  while (k + 1 < N && levels[k].degrees < degrees) ++k;
  const ScreenLevel& from = levels[k - 1];
  const ScreenLevel& to = levels[k];
  return from.decibel +
         (to.decibel - from.decibel) * (degrees - from.degrees) / (to.degrees - from.degrees);
}

double normal_share(double x) noexcept {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// An exponential of mean `spread` to either side, blurred by a Gaussian of deviation `blur`; times
/// a constant.
double blurred_exponential(double x, double spread, double blur) noexcept {
  const double shift = blur / spread;
  return std::exp(-x / spread) * normal_share(x / blur - shift) +
         std::exp(x / spread) * normal_share(-x / blur - shift);
}

}  // namespace

std::optional<NeedleShape> needle_of_gauge(int gauge) {
  const auto shape = [](double outer_mm, double bore_mm) {
    return NeedleShape{outer_mm * kMillimetre, bore_mm * kMillimetre};
  };
  switch (gauge) {
    case 18:
      return shape(1.270, 0.838);
    case 19:
      return shape(1.067, 0.686);
    case 20:
      return shape(0.908, 0.603);
    case 21:
      return shape(0.819, 0.514);
    case 22:
      return shape(0.717, 0.413);
    case 27:
      return shape(0.413, 0.210);
    case 23:
      return shape(0.642, 0.337);
    case 25:
      return shape(0.515, 0.260);
    default:
      return std::nullopt;
  }
}

double reverberation_pitch(const NeedleShape& shape) noexcept {
  const double walls = shape.outer_diameter - shape.bore;
  return kDisplaySpeedOfSound * (walls / kSteelSpeed + shape.bore / kBoreSpeed);
}

double needle_reflectivity(const NeedleShape& shape, double angle, double specular_phase) noexcept {
  const double tilt = std::min(std::abs(angle), std::numbers::pi / 2);
  const double spread = shape.echogenic ? kEchogenicSlopes : kPlainSlopes;
  // the lobe's intensity falls as exp(-2 (phase * tilt)^2)
  const double blur = 0.5 / std::max(1.0, specular_phase);
  const double share =
      blurred_exponential(tilt, spread, blur) / blurred_exponential(0, spread, blur);
  return kSteelReflection * std::sqrt(share);
}

double needle_on_screen(const NeedleShape& shape, double angle) noexcept {
  const double degrees = std::min(std::abs(angle) / kDegree, 90.0);
  const double decibel =
      shape.echogenic ? level_at(kDimpledLevels, degrees) : level_at(kPlainLevels, degrees);
  return std::pow(10.0, decibel / 20);
}

}  // namespace artus
