// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/pneumatic_cylinder.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

/// Central difference of a function of the state along its own motion, with Richardson's
/// extrapolation: fourth order in the time step.
template <class F>
double rate_along_motion(const CylinderParams& c, const CylinderState& s, const ChamberFlows& q,
                         F value) {
  const PressureRates rates = pressure_rates(c, s, q);
  const auto at = [&](double t) {
    CylinderState moved = s;
    moved.y += s.v * t;
    moved.p_P += rates.dp_P * t;
    moved.p_N += rates.dp_N * t;
    return value(c, moved);
  };
  const auto central = [&](double h) {
    return (at(h) - at(-h)) / (2 * h);
  };
  const double h = 1e-4;
  return (4 * central(h / 2) - central(h)) / 3;
}

struct Sample {
  CylinderState state;
  ChamberFlows flows;
};

Sample random_sample(std::uint64_t i) {
  const auto between = [&](std::uint64_t k, double low, double high) {
    return low + (high - low) * uniform_noise(7, 16 * i + k);
  };
  Sample s;
  s.state = {between(0, -0.02, 0.02), between(1, -0.3, 0.3), between(2, 1e5, 4e5),
             between(3, 1e5, 4e5)};
  s.flows = {between(4, -1e-3, 1e-3), between(5, -1e-3, 1e-3)};
  return s;
}

TEST(PneumaticCylinder, SmallestStiffnessIsThePublishedOne) {
  EXPECT_NEAR(min_pneumatic_stiffness(CylinderParams{}, 1e5), 692.14, 692.14e-3);
}

TEST(PneumaticCylinder, NoPositionIsSofterThanTheSmallestStiffness) {
  // Each chamber at the exhaust's pressure is what (3.43) means; the minimum is over the stroke.
  const CylinderParams c;
  double least = 1e9;
  for (int i = -2400; i <= 2400; ++i) {
    least = std::min(least, max_pneumatic_stiffness(c, 1e5, i * 1e-5));
  }
  EXPECT_NEAR(least, min_pneumatic_stiffness(c, 1e5), 0.01);
}

TEST(PneumaticCylinder, LargestStiffnessIsThePublishedOneAtTheEndStopUnderSupplyPressure) {
  const CylinderParams c;
  EXPECT_NEAR(max_pneumatic_stiffness(c, 4e5, -c.travel), 14155, 0.01 * 14155);
}

TEST(PneumaticCylinder, ActiveTransformAndItsInverseCancel) {
  const CylinderParams c;
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Sample s = random_sample(i);
    const ChamberFlows back = to_chambers(c, s.state.y, to_active(c, s.state.y, s.flows));
    EXPECT_NEAR(back.q_P, s.flows.q_P, 1e-15);
    EXPECT_NEAR(back.q_N, s.flows.q_N, 1e-15);
  }
}

TEST(PneumaticCylinder, ForceRateEqualsThatOfTheChambers) {
  const CylinderParams c;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Sample s = random_sample(i);
    const double direct = rate_along_motion(c, s.state, s.flows, pneumatic_force);
    const double identity = force_rate(c, s.state, to_active(c, s.state.y, s.flows));
    EXPECT_NEAR(identity, direct, 1e-6 * (std::abs(direct) + 1)) << i;
  }
}

TEST(PneumaticCylinder, StiffnessRateEqualsThatOfTheChambers) {
  const CylinderParams c;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Sample s = random_sample(i);
    const double direct = rate_along_motion(c, s.state, s.flows, pneumatic_stiffness);
    const double identity = stiffness_rate(c, s.state, to_active(c, s.state.y, s.flows));
    EXPECT_NEAR(identity, direct, 1e-6 * (std::abs(direct) + 1e3)) << i;
  }
}

TEST(PneumaticCylinder, ClosedChamberKeepsPressureTimesVolumeToThePolytropicPower) {
  const CylinderParams c;
  CylinderState s{0.003, 0.2, 3e5, 2e5};
  const PressureRates rates = pressure_rates(c, s, {});
  // d(p V^k) = 0: dp/p + k dV/V = 0, with V_P growing and V_N shrinking.
  EXPECT_NEAR(rates.dp_P / s.p_P + c.polytropic * s.v / c.length_p(s.y), 0, 1e-9);
  EXPECT_NEAR(rates.dp_N / s.p_N - c.polytropic * s.v / c.length_n(s.y), 0, 1e-9);
}

}  // namespace
}  // namespace artus
