// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/servovalve.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "artus/detail/haptics/actuator/valve_map.h"

namespace artus {
namespace {

constexpr double kRoom = 293.15;  // K

TEST(Servovalve, PassesTheCataloguesNominalFlow) {
  // 100 l/min of reference air at 6 -> 5 bar gauge.
  const ServovalveParams valve;
  const double q = orifice_flow(valve, 1, 7e5, 6e5, kRoom);
  EXPECT_NEAR(q / kReferenceDensity * 60000, 100, 1.0);
}

TEST(Servovalve, FlowIsSonicBelowTheCriticalRatioAndVanishesAtEqualPressures) {
  const ServovalveParams valve;
  const double sonic = valve.sonic_conductance * kReferenceDensity * 4e5;
  EXPECT_NEAR(orifice_flow(valve, 1, 4e5, 1.1e5, kRoom), sonic, 1e-9);
  EXPECT_NEAR(orifice_flow(valve, 1, 4e5, 0, kRoom), sonic, 1e-9);
  EXPECT_EQ(orifice_flow(valve, 1, 4e5, 4e5, kRoom), 0);
  EXPECT_EQ(orifice_flow(valve, 1, 1e5, 3e5, kRoom), -orifice_flow(valve, 1, 3e5, 1e5, kRoom));
}

TEST(Servovalve, PortFlowRisesWithOpeningAndFallsWithPressure) {
  const ServovalveParams valve;
  for (double p = 1e5; p <= 4e5; p += 0.25e5) {
    for (double x = -1; x < 1; x += 0.01) {
      EXPECT_LT(port_flow(valve, x, p, 298), port_flow(valve, x + 0.01, p, 298));
      EXPECT_GE(port_flow(valve, x, p, 298), port_flow(valve, x, p + 1e4, 298));
    }
  }
}

TEST(Servovalve, SpoolReachesSixtyThreePercentAfterItsTimeConstant) {
  const ServovalveParams valve;
  const double tau = 1 / (2 * std::acos(-1.0) * valve.spool_frequency);
  double whole = step_spool(valve, 0, 1, tau);
  EXPECT_NEAR(whole, 1 - std::exp(-1.0), 1e-12);
  double parts = 0;
  for (int i = 0; i < 10; ++i) parts = step_spool(valve, parts, 1, tau / 10);
  EXPECT_NEAR(parts, whole, 1e-12);
}

TEST(Servovalve, VoltagesBeyondTheRangeOpenFullyAndNanCloses) {
  const ServovalveParams valve;
  EXPECT_EQ(opening_of(valve, 12), 1);
  EXPECT_EQ(opening_of(valve, -3), -1);
  EXPECT_EQ(opening_of(valve, std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_DOUBLE_EQ(voltage_of(valve, opening_of(valve, 6.25)), 6.25);
}

TEST(ValveMap, AgreesWithTheValveItSamples) {
  const PneumaticParams params;
  const ValveMap map(params.valve, params.cylinder);
  const double full = port_flow(params.valve, 1, 1e5, params.cylinder.temperature);
  for (double p = 1e5; p <= 3.9e5; p += 0.13e5) {
    for (double x = -0.99; x < 1; x += 0.037) {
      EXPECT_NEAR(map.flow(x, p), port_flow(params.valve, x, p, params.cylinder.temperature),
                  0.005 * full);
    }
  }
}

TEST(ValveMap, InverseGivesTheOpeningBack) {
  const PneumaticParams params;
  const ValveMap map(params.valve, params.cylinder);
  for (double y = -0.02; y <= 0.02; y += 0.005) {
    for (double x = -0.95; x < 1; x += 0.05) {
      const double q = map.active_flow(x, 2.7e5, 2.9e5, y);
      EXPECT_NEAR(map.find_active_opening(q, 2.7e5, 2.9e5, y), x, 1e-9);
      EXPECT_NEAR(map.find_opening(map.flow(x, 2.2e5), 2.2e5), x, 1e-9);
    }
  }
}

TEST(ValveMap, FlowsOutOfReachOpenFully) {
  const PneumaticParams params;
  const ValveMap map(params.valve, params.cylinder);
  EXPECT_EQ(map.find_active_opening(1, 2e5, 2e5, 0), 1);
  EXPECT_EQ(map.find_active_opening(-1, 2e5, 2e5, 0), -1);
  EXPECT_EQ(map.find_opening(1, 2e5), 1);
}

}  // namespace
}  // namespace artus
