// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/space_pressure.h"

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/haptics/plunger/patient.h"
#include "artus/detail/haptics/plunger/syringe.h"

namespace artus {
namespace {

constexpr double kMercury = 133.322;  // Pa/mmHg

SpaceLaw law_of(const std::string& name) {
  const auto profiles = read_bundled_space_profiles();
  for (const SpaceProfile& p : *profiles)
    if (p.space.name == name) return p.space.law;
  ADD_FAILURE() << "no space " << name;
  return {};
}

TEST(SpacePressure, OfShouldersHasTheCurvesOfTheReference) {
  struct Row {
    const char* space;
    std::array<double, 5> pressure;  // mmHg at 5, 10, 15, 20, 25 ml; below 0: ruptured by then
  };
  constexpr std::array<Row, 4> kRows{{{"joint", {0, 0, 2.5, 10, 20}},
                                      {"capsulitis_man", {8, 90, 190, 290, -1}},
                                      {"capsulitis_woman", {11.8, 132.75, 280.25, -1, -1}},
                                      {"capsulitis_first_visit", {53.55, 285.6, -1, -1, -1}}}};
  for (const Row& row : kRows) {
    SpaceLaw law = law_of(row.space);
    for (std::size_t k = 0; k < 5; ++k) {
      const double ml = 5 * static_cast<double>(k + 1);
      if (row.pressure[k] < 0 || ml * kCubicCentimetre > law.yield) continue;
      EXPECT_NEAR(pressure_of(law, ml * kCubicCentimetre) / kMercury, row.pressure[k],
                  0.02 * row.pressure[k] + 1e-3)
          << row.space << ' ' << ml;
    }
  }
}

TEST(SpacePressure, OfTheBursaFollowsItsMeasuredComplianceAtRest) {
  const SpaceLaw law = law_of("bursa");
  for (const auto& [ml, mercury] : {std::pair{1.0, 19.1}, {5.0, 63.6}, {10.0, 119.1}})
    EXPECT_NEAR(pressure_of(law, ml * kCubicCentimetre) / kMercury, mercury, 0.02 * mercury);
}

TEST(SpacePressure, HasNoStepAndTheSlopeThatItSays) {
  const auto profiles = read_bundled_space_profiles();
  ASSERT_TRUE(profiles);
  for (const SpaceProfile& p : *profiles) {
    const SpaceLaw& law = p.space.law;
    for (double v = -1.05e-6; v < 60e-6; v += 0.0637e-6) {
      constexpr double kStep = 1e-12;
      const double rise = (pressure_of(law, v + kStep) - pressure_of(law, v - kStep)) / (2 * kStep);
      EXPECT_NEAR(rise, slope_of(law, v), 1e-3 * std::abs(rise) + 2e5) << p.space.name << ' ' << v;
    }
  }
}

TEST(SpacePressure, OfASplitFallsWithTheFifthRootOfItsVolume) {
  const SpaceLaw law = law_of("tendon");
  EXPECT_DOUBLE_EQ(pressure_of(law, law.peak_volume), law.peak);
  EXPECT_NEAR(pressure_of(law, 32 * law.peak_volume), law.peak / 2, 1e-6 * law.peak);
  EXPECT_DOUBLE_EQ(opening_of(law, 0), law.opening);
}

TEST(SpacePressure, OfAClosedFilmIsTheCubeLawOverThePatchThatIsParted) {
  const SpaceLaw law = law_of("bursa");
  // 0.1 ml/s of water between plates 0.05, 0.1 and 0.2 mm apart: 37, 4.6 and 0.6 mmHg.
  const auto drop = [&](double volume) {
    return film_resistance(law, volume, 1e-3) * 1e-7 / kMercury;
  };
  // Over 2.5 of 20 cm2 at first, and with a radius as the third root from 0.13 ml on.
  const auto volume = [](double h) {
    return h * 2.5e-4;
  };
  EXPECT_NEAR(drop(0), 37, 0.5);
  EXPECT_NEAR(drop(volume(0.05e-3)), 4.6, 0.1);
  EXPECT_NEAR(drop(volume(0.15e-3)), 0.58, 0.02);
  EXPECT_NEAR(drop(0.375e-6), drop(0) * std::pow(0.05 / 0.8, 3), 1e-9)
      << "a quarter of it, 0.75 mm";
  EXPECT_NEAR(drop(6e-6), drop(0) * std::pow(0.05 / 3.05, 3), 1e-9) << "all of it, 3 mm";
  EXPECT_EQ(film_resistance(law_of("muscle"), 0, 1e-3), 0);
}

TEST(Syringe, IsTheSmallestThatHoldsTheVolume) {
  EXPECT_DOUBLE_EQ(syringe_for(5e-6).volume, 5e-6);
  EXPECT_DOUBLE_EQ(syringe_for(5.1e-6).volume, 10e-6);
  EXPECT_DOUBLE_EQ(syringe_for(0.2e-6).volume, 1e-6);
  EXPECT_DOUBLE_EQ(syringe_for(80e-6).filled, 50e-6);
  // 10 N on 1 and on 10 ml.
  EXPECT_NEAR(10 / syringe_for(1e-6).area(), 576e3, 1e3);
  EXPECT_NEAR(10 / syringe_for(10e-6).area(), 60.6e3, 0.1e3);
}

TEST(Patient, ComplainsOfANerveAndNotOfABursa) {
  PlungerParams params;
  std::vector<Space> spaces(2);
  spaces[0].law = law_of("bursa");
  spaces[0].like = "bursa";
  spaces[1].law = law_of("nerve");
  spaces[1].like = "nerve";
  Plunger plunger(params, spaces, 1e-3);
  PlungerInput input;
  input.force = 30;
  input.tip[0] = {0, 1};
  for (int k = 0; k < 200; ++k) plunger.step(input);
  input.force = 5;
  for (int k = 0; k < 200; ++k) plunger.step(input);
  EXPECT_GT(plunger.states()[0].volume, 0);
  EXPECT_EQ(patient_says(plunger, 0), "");
  input.force = 40;
  input.tip[0] = {1, 1};
  for (int k = 0; k < 200; ++k) plunger.step(input);
  EXPECT_GT(plunger.states()[1].volume, 0);
  EXPECT_NE(patient_says(plunger, 1), "");
}

}  // namespace
}  // namespace artus
