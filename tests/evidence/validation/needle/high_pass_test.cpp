// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/needle/high_pass.h"

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kRate = 1000;  // Hz

// Energy, N^2 s, of what passes of a signal over `seconds`, the first `skip` of them left out.
template <class F>
double passed_energy(double cut, double seconds, double skip, F signal) {
  HighPass filter(cut, kRate);
  double energy = 0;
  for (int i = 0; i < static_cast<int>(seconds * kRate); ++i) {
    const double y = filter.step(signal(i / kRate));
    if (i >= skip * kRate) energy += y * y / kRate;
  }
  return energy;
}

// A sine of frequency f passes by 1 / sqrt(1 + (w_c / w)^16), frequencies warped as the bilinear
// form has them: w = tan(pi f / rate).
TEST(HighPass, SineIsPassedAsTheButterworthOfOrderEightSays) {
  constexpr double kCut = 20;  // Hz
  for (const double f : {8.0, 12.0, 18.0, 20.0, 25.0, 40.0, 150.0}) {
    const double warped = std::tan(kTwoPi / 2 * kCut / kRate) / std::tan(kTwoPi / 2 * f / kRate);
    const double gain = 1 / std::sqrt(1 + std::pow(warped, 16));
    const double energy =
        passed_energy(kCut, 6, 2, [f](double t) { return std::sin(kTwoPi * f * t); });
    EXPECT_NEAR(energy / (0.5 * 4), gain * gain, 1e-3 * gain * gain + 1e-9) << f << " Hz";
  }
}

TEST(HighPass, TremorAtTenHertzIsNotAboveTwentyHertz) {
  const double energy = passed_energy(20, 6, 2, [](double t) { return std::sin(kTwoPi * 10 * t); });
  EXPECT_LT(energy / 2, 2e-5);
}

// A step of a newton has a^2 / (pi w) above w.
TEST(HighPass, StepHasTheEnergyOfItsSpectrum) {
  const double expected = 1 / (kTwoPi / 2 * kTwoPi * 20);
  const double energy = passed_energy(20, 3, 0, [](double t) { return t < 1 ? 0.0 : 1.0; });
  EXPECT_NEAR(energy, expected, 0.12 * expected);  // sampling cuts at 500 Hz, the edge is soft
}

TEST(HighPass, CornerHasTheEnergyOfItsSpectrum) {
  for (const double slope : {5.0, 10.0, 20.0}) {
    const double energy =
        passed_energy(20, 3, 0, [slope](double t) { return t < 1 ? 0.0 : slope * (t - 1); });
    EXPECT_NEAR(energy, corner_energy(slope, 20), 0.1 * corner_energy(slope, 20)) << slope;
  }
}

}  // namespace
}  // namespace artus
