// SPDX-License-Identifier: AGPL-3.0-or-later
#include "echo/needle_view.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace artus {
namespace {

constexpr double kSteelSpeed = 5800;        // m/s
constexpr double kBoreSpeed = 1480;         // m/s, water in the bore
constexpr double kSteelReflection = 0.933;  // -0.6 dB, muscle on steel
constexpr double kPlainFall = 54.0 / 75;  // dB per degree: 10 % of the grey of 60 dB is left at 75
constexpr double kEchogenicFall = 24.0 / 75;  // dB per degree: 60 % is left at 75

}  // namespace

std::optional<NeedleShape> needle_of_gauge(int gauge) {
  const auto shape = [](double outer_mm, double bore_mm) {
    return NeedleShape{outer_mm * kMillimetre, bore_mm * kMillimetre};
  };
  switch (gauge) {
    case 18:
      return shape(1.270, 0.838);
    case 20:
      return shape(0.908, 0.603);
    case 21:
      return shape(0.819, 0.514);
    case 22:
      return shape(0.717, 0.413);
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

double needle_reflectivity(const NeedleShape& shape, double angle) noexcept {
  const double degrees = std::min(std::abs(angle) / kDegree, 90.0);
  const double fall = shape.echogenic ? kEchogenicFall : kPlainFall;
  return kSteelReflection * std::pow(10.0, -fall * degrees / 20);
}

}  // namespace artus
