// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/needle_flow.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr Viscosity kWater{1e-3, 1e-3, 0, 1};
constexpr double kDensity = 1000;  // kg/m^3

NeedleFlow water_in(int gauge, double length, double entry_loss = NeedleFlow::kEntryLoss) {
  return {*bore_of_gauge(gauge, length), kWater, kDensity, entry_loss};
}

TEST(NeedleFlow, OfWaterHasThePublishedTablesPressureDrops) {
  struct Row {
    int gauge;
    double length;
    double flow;
    double drop;
  };
  // Made by an independent model in Python.
  constexpr std::array<Row, 9> kRows{{{18, 0.040, 1e-7, 366.639813},
                                      {18, 0.090, 5e-7, 4621.907539},
                                      {20, 0.050, 2e-7, 3621.218653},
                                      {21, 0.050, 1e-7, 3174.102560},
                                      {22, 0.050, 5e-7, 50333.942668},
                                      {22, 0.090, 2e-7, 27659.382419},
                                      {23, 0.030, 1e-7, 10859.390423},
                                      {25, 0.025, 5e-7, 209006.386751},
                                      {25, 0.038, 1e-7, 37782.828192}}};
  for (const Row& row : kRows) {
    const NeedleFlow needle = water_in(row.gauge, row.length);
    EXPECT_NEAR(needle.drop(row.flow) / row.drop, 1, 1e-6) << row.gauge;
    EXPECT_NEAR(needle.flow(row.drop) / row.flow, 1, 1e-6) << row.gauge;
  }
}

TEST(NeedleFlow, OfTwiceTheBoreIsSixteenfoldAndOf25GaugeAfter22FifteenPercent) {
  const NeedleFlow narrow({0.3e-3, 0.6e-3, 0.05}, kWater, kDensity, 0);
  const NeedleFlow wide({0.6e-3, 0.9e-3, 0.05}, kWater, kDensity, 0);
  EXPECT_NEAR(wide.flow(1e4) / narrow.flow(1e4), 16, 1e-9);
  EXPECT_NEAR(water_in(25, 0.05, 0).flow(1e4) / water_in(22, 0.05, 0).flow(1e4), 0.157, 5e-4);
}

TEST(NeedleFlow, InversesMeetOverTenDecadesWithAndWithoutResistanceInSeries) {
  const Viscosity thinning{5, 1e-3, 1, 0.35};
  const NeedleFlow both[] = {water_in(22, 0.05), {*bore_of_gauge(22, 0.05), thinning, kDensity}};
  for (const NeedleFlow& needle : both) {
    for (const double extra : {0.0, 1e9, 1e12}) {
      double last = 0;
      for (double dp = 1e-3; dp < 1e7; dp *= 3) {
        const double q = needle.flow(dp, extra);
        EXPECT_NEAR(needle.drop(q, extra) / dp, 1, 1e-9);
        EXPECT_EQ(needle.flow(-dp, extra), -q);
        EXPECT_GT(q, last);
        last = q;
      }
    }
  }
}

TEST(NeedleFlow, OfAPowerLawLiquidFollowsItsClosedForm) {
  constexpr double kPower = 0.5;
  constexpr double kConsistency = 0.2;  // Pa s^n
  constexpr double kLambda = 1e6;       // s: the plateau is out of sight
  const Viscosity liquid{kConsistency * std::pow(kLambda, 1 - kPower), 1e-9, kLambda, kPower};
  const NeedleBore bore = *bore_of_gauge(22, 0.05);
  const NeedleFlow needle(bore, liquid, kDensity, 0);
  const double r = bore.diameter / 2;
  for (const double q : {1e-8, 1e-7, 1e-6}) {
    const double wanted =
        2 * kConsistency * bore.length / r *
        std::pow((3 * kPower + 1) / kPower * q / (std::numbers::pi * r * r * r), kPower);
    EXPECT_NEAR(needle.drop(q) / wanted, 1, 1e-3);
  }
}

TEST(NeedleFlow, OfHyaluronicAcidAgreesWithAnIndependentRabinowitschIntegral) {
  struct Row {
    double zero;
    double lambda;
    double power;
    int gauge;
    double flow;
    double drop;
  };
  // Made by an independent model in Python, 40 mm of needle, without the loss at the entry.
  constexpr std::array<Row, 9> kRows{{{0.3, 0.05, 0.5, 18, 5e-8, 8566.0359},
                                      {0.3, 0.05, 0.5, 22, 1e-7, 75449.0999},
                                      {0.3, 0.05, 0.5, 25, 1e-7, 258285.2679},
                                      {5, 1, 0.35, 18, 1e-7, 15194.7581},
                                      {5, 1, 0.35, 21, 5e-8, 32977.8242},
                                      {5, 1, 0.35, 22, 1e-7, 69365.4969},
                                      {5, 1, 0.35, 25, 1e-7, 201582.1909},
                                      {200, 30, 0.25, 18, 5e-8, 18784.9442},
                                      {200, 30, 0.25, 25, 1e-7, 211759.3113}}};
  for (const Row& row : kRows) {
    const Viscosity liquid{row.zero, 1e-3, row.lambda, row.power};
    const NeedleFlow needle(*bore_of_gauge(row.gauge, 0.04), liquid, kDensity, 0);
    EXPECT_NEAR(needle.drop(row.flow) / row.drop, 1, 1e-3) << row.gauge << ' ' << row.zero;
  }
}

TEST(NeedleFlow, RefusesAGaugeThatIsNotInTheTable) {
  EXPECT_FALSE(bore_of_gauge(24, 0.05));
  EXPECT_THROW(NeedleFlow({0, 1e-3, 0.05}, kWater, kDensity), std::invalid_argument);
}

}  // namespace
}  // namespace artus
