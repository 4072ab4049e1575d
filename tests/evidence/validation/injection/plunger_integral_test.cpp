// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/injection/plunger_integral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace artus {
namespace {

/// 5 ml of water behind 22 G, without the loss at the entry, into 0.675 ml a kilopascal.
IntegralSetup setup_into_a_compliance() {
  IntegralSetup setup;
  setup.plunger.entry_loss = 0;
  setup.law.kind = SpaceKind::cavity;
  setup.law.rest = 1e3;
  setup.law.stiffness = 1 / 6.75e-10;
  setup.thumb.force = [](double) {
    return 8.0;
  };
  setup.thumb.place = [](double) {
    return 0.0;
  };
  return setup;
}

TEST(PlungerIntegral, FillsAComplianceAsItsClosedFormSays) {
  const IntegralSetup setup = setup_into_a_compliance();
  const Syringe& syringe = setup.plunger.syringe;
  const double over = (8 - syringe.glide) / syringe.area() - setup.law.rest;
  const double resistance = 128 * 1e-3 * setup.plunger.needle.length /
                            (std::numbers::pi * std::pow(setup.plunger.needle.diameter, 4));
  const double tau = resistance * 6.75e-10;
  for (const IntegralRow& row : integrate_plunger(setup, 20, 0.5, 0.01)) {
    const double volume = 6.75e-10 * over * (1 - std::exp(-row.time / tau));
    EXPECT_NEAR(row.volume, volume, 1e-9 * over * 6.75e-10) << row.time;
    EXPECT_NEAR(row.travel * syringe.area(), volume + 1e-12 * row.pressure, 1e-15) << row.time;
  }
}

TEST(PlungerIntegral, AStoppedPlungersPressureFallsAsItsClosedFormSays) {
  IntegralSetup setup = setup_into_a_compliance();
  setup.law.rest = 0;
  setup.plunger.syringe.compliance = 2e-12;
  setup.plunger.syringe.break_loose = 7;
  setup.plunger.syringe.glide = 0;
  // Pressed for 10 ms, then let go to where friction alone holds it.
  setup.thumb.force = [](double t) {
    return std::clamp(8 - 300 * (t - 0.01), 5.0, 8.0);
  };
  const auto rows = integrate_plunger(setup, 0.5, 0.02, 1e-4);
  const double cs = setup.plunger.syringe.softness();
  const double series = cs * 6.75e-10 / (cs + 6.75e-10);
  const double resistance = 128 * 1e-3 * setup.plunger.needle.length /
                            (std::numbers::pi * std::pow(setup.plunger.needle.diameter, 4));
  const double excess = rows[1].pressure - rows[1].volume / 6.75e-10;
  for (std::size_t k = 2; k < rows.size(); ++k) {
    const double left = rows[k].pressure - rows[k].volume / 6.75e-10;
    const double wanted = excess * std::exp(-(rows[k].time - 0.02) / (resistance * series));
    EXPECT_NEAR(left, wanted, 1e-6 * excess) << rows[k].time;
    EXPECT_EQ(rows[k].travel, rows[1].travel);
  }
}

/// Where it opens and breaks loose does not depend on the step.
TEST(PlungerIntegral, MeetsWhatHappensAtItsInstant) {
  IntegralSetup setup = setup_into_a_compliance();
  setup.law.opening = 20e3;
  setup.thumb.force = [](double t) {
    return 50 * t;
  };
  const double coarse = integrate_plunger(setup, 0.2, 0.2, 5e-3).back().volume;
  const double fine = integrate_plunger(setup, 0.2, 0.2, 1e-5).back().volume;
  ASSERT_GT(fine, 0);
  EXPECT_NEAR(coarse / fine, 1, 1e-5);
}

}  // namespace
}  // namespace artus
