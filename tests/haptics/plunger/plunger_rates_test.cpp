// SPDX-License-Identifier: AGPL-3.0-or-later
// A tick's length hardly matters: what happens in one happens at its own instant.
#include <array>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "artus/detail/haptics/plunger/plunger.h"
#include "tests/haptics/plunger/plunger_fixture.h"

namespace artus {
namespace {

using namespace test;

/// One needle, one liquid, one barrel, one hand.
struct RateCase {
  int gauge = 22;
  double length = 0.04;  // m
  Viscosity viscosity;
  double barrel = 5e-6;   // m^3
  double tremor = 1e-4;   // m
  double pace = 60;       // rad/s of it
  double duration = 1;    // s
  bool by_force = false;  // otherwise the thumb leads the plunger by a spring
};

/// Flow (m^3/s) into a muscle that first has to part, at each hundredth of a second.
std::vector<double> flows_at(double rate, const RateCase& c) {
  PlungerParams params = water_syringe();
  params.syringe = syringe_for(c.barrel);
  params.needle = *bore_of_gauge(c.gauge, c.length);
  params.liquid.viscosity = c.viscosity;
  SpaceLaw split;
  split.kind = SpaceKind::split;
  split.opening = 8e3;
  split.peak = 20e3;
  split.peak_volume = 0.1e-6;
  Plunger plunger(params, one_space(split), 1 / rate);
  std::vector<double> flows;
  PlungerInput input = thumb(0);
  const int each = static_cast<int>(std::lround(rate / 100));
  for (int k = 0; k < static_cast<int>(c.duration * rate); ++k) {
    const double t = k / rate;
    if (c.by_force) {
      const double push = params.syringe.break_loose + params.syringe.area() * 4e4 * t;
      input.force = push * (1 + 2e3 * c.tremor * std::sin(c.pace * t));
    } else {
      input.stiffness = 2000;
      input.position = 4e-3 * t + c.tremor * std::sin(c.pace * t);
    }
    plunger.step(input);
    if (k % each == 0) flows.push_back(plunger.state().flow);
  }
  return flows;
}

/// Root of the mean square of what differs, of that of the flow.
double difference(const std::vector<double>& flows, const std::vector<double>& fine) {
  double sum = 0;
  for (std::size_t k = 0; k < flows.size(); ++k) sum += std::pow(flows[k] - fine[k], 2);
  return std::sqrt(sum / std::inner_product(fine.begin(), fine.end(), fine.begin(), 1e-30));
}

void expect_same_at_all_rates(const RateCase& c, const std::string& name) {
  const auto fine = flows_at(20e3, c);
  for (const double rate : {1e3, 2e3, 10e3})
    EXPECT_LT(difference(flows_at(rate, c), fine), 0.02) << name << " at " << rate << " Hz";
}

TEST(PlungerRates, TwoPercentHoldForEachNeedleLiquidAndBarrel) {
  constexpr std::array<Viscosity, 5> kLiquids{{{1e-3, 1e-3, 0, 1},
                                               {4e-3, 4e-3, 0, 1},
                                               {11e-3, 11e-3, 0, 1},
                                               {0.3, 1e-3, 0.05, 0.5},
                                               {5, 1e-3, 1, 0.35}}};
  for (const int gauge : {18, 19, 20, 21, 22, 23, 25, 27})
    for (std::size_t k = 0; k < kLiquids.size(); ++k)
      for (const double barrel : {1e-6, 2.5e-6, 5e-6, 10e-6, 20e-6, 50e-6})
        expect_same_at_all_rates({gauge, 0.04, kLiquids[k], barrel, 1.5e-4, 50},
                                 std::to_string(gauge) + " G, liquid " + std::to_string(k) + ", " +
                                     std::to_string(barrel * 1e6) + " ml");
}

TEST(PlungerRates, TwoPercentHoldForEachLengthAndTremor) {
  for (const int gauge : {18, 20, 22, 25})
    for (const double length : {0.016, 0.038, 0.07, 0.12})
      for (const double tremor : {1e-4, 2e-4, 3e-4})
        expect_same_at_all_rates({gauge, length, {}, 50e-6, tremor, 60, 2},
                                 std::to_string(gauge) + " G of " + std::to_string(length) +
                                     " m, tremor " + std::to_string(tremor));
}

TEST(PlungerRates, TwoPercentHoldForAThumbThatIsAForce) {
  for (const int gauge : {18, 21, 27})
    for (const double barrel : {1e-6, 5e-6, 20e-6})
      for (const double tremor : {0.0, 1e-4})
        expect_same_at_all_rates({gauge, 0.05, {}, barrel, tremor, 45, 2, true},
                                 std::to_string(gauge) + " G, " + std::to_string(barrel * 1e6) +
                                     " ml, tremor " + std::to_string(tremor));
}

/// The stopper breaks loose between two ticks: when, and how much is given, is what a step a
/// hundredth as long gives.
TEST(PlungerRates, TheStopperBreaksLooseAtItsInstant) {
  const auto given = [](double rate) {
    PlungerParams params = water_syringe(0);
    Plunger plunger(params, one_space(level(0)), 1 / rate);
    for (int k = 0; k <= static_cast<int>(0.0505 * rate); ++k) plunger.step(thumb(60.1 * k / rate));
    return plunger.states()[0].volume;
  };
  // 3 N after 49.917 ms: 0.583 ms of flow until 50.5 ms, at 1 N over 2 N of friction and more.
  const double fine = given(1e6);
  ASSERT_GT(fine, 0);
  EXPECT_NEAR(given(2e3) / fine, 1, 0.02);
}

}  // namespace
}  // namespace artus
