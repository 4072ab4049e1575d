// SPDX-License-Identifier: AGPL-3.0-or-later
// Against the numbers of an independent model in Python (its own integrator, steps of 0.02 to 1
// ms).
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/haptics/plunger/plunger.h"
#include "tests/haptics/plunger/plunger_fixture.h"

namespace artus {
namespace {

using namespace test;

struct OracleRow {
  double time;      // s
  double travel;    // m
  double volume;    // m^3
  double pressure;  // Pa in the barrel
};

template <std::size_t n, class Force>
void expect_rows(Plunger& plunger, double dt, const std::array<OracleRow, n>& rows, Force force,
                 double scale_volume) {
  std::size_t row = 0;
  for (int k = 1; row < n; ++k) {
    const double t = k * dt;
    plunger.step(thumb(force(t)));
    if (t < rows[row].time - dt / 2) continue;
    EXPECT_NEAR(plunger.state().travel / rows[row].travel, 1, 1e-3) << t;
    EXPECT_NEAR(plunger.states()[0].volume, rows[row].volume, 1e-3 * scale_volume) << t;
    EXPECT_NEAR(plunger.state().pressure / rows[row].pressure, 1, 2e-3) << t;
    ++row;
  }
}

TEST(PlungerOracle, ABursaFillsAlike) {
  PlungerParams params = water_syringe();
  SpaceLaw law = compliance(kRest, 1 / kCompliance);
  law.opening = 2e3;
  Plunger plunger(params, one_space(law), 1e-3);
  constexpr std::array<OracleRow, 5> kRows{{{0.5, 0.002679385483, 2.535441646e-07, 52525.08373},
                                            {2, 0.009264001221, 1.005712303e-06, 52525.08373},
                                            {5, 0.02210193452, 2.472204011e-06, 52525.08373},
                                            {10, 0.04253591573, 4.806400904e-06, 52525.08373},
                                            {30, 0.1129620187, 1.285125468e-05, 52525.08373}}};
  expect_rows(
      plunger, 1e-3, kRows, [](double) { return 8.0; }, 1e-6);
}

/// The model's air is as soft as it is at rest: a softer barrel.
constexpr double kAirAtRest = 0.2 * kCubicCentimetre / Syringe::kAtmosphere;

TEST(PlungerOracle, ABursaFillsAlikeFromASoftBarrel) {
  PlungerParams params = water_syringe();
  params.syringe.compliance += kAirAtRest;
  Plunger plunger(params, one_space(compliance(kRest, 1 / kCompliance)), 1e-4);
  constexpr std::array<OracleRow, 3> kRows{{{1, 0.008786693745, 7.43378114e-07, 87541.80622},
                                            {2, 0.01523465852, 1.479936457e-06, 87541.80622},
                                            {3.9, 0.02732217641, 2.860707361e-06, 87541.80622}}};
  expect_rows(
      plunger, 1e-4, kRows, [](double) { return 12.0; }, 1e-6);
}

TEST(PlungerOracle, ALeakOverAYieldPressureSettlesAlike) {
  PlungerParams params = water_syringe();
  std::vector<Space> spaces = one_space(compliance(kRest, 20 / kCompliance));
  spaces[0].leaks_to = "sink";
  spaces[0].leak_opening = 20e3;
  spaces[0].leak_resistance = 5e10;
  spaces.push_back(one_space(level(0), "sink")[0]);
  params.grip = 1e9;
  Plunger plunger(params, spaces, 1e-3);
  constexpr std::array<OracleRow, 5> kRows{{{1, 0.005621754827, 5.72145997e-07, 70033.44498},
                                            {2, 0.009684303728, 9.4759272e-07, 70033.44498},
                                            {5, 0.01965966786, 1.21268438e-06, 70033.44498},
                                            {10, 0.03517750747, 1.234774497e-06, 70033.44498},
                                            {20, 0.06609574746, 1.235087401e-06, 70033.44498}}};
  expect_rows(
      plunger, 1e-3, kRows, [](double) { return 10.0; }, 1e-6);
}

TEST(PlungerOracle, AThinNeedleFillsAComplianceAlikeAtConstantPressure) {
  PlungerParams params = water_syringe(0);
  params.syringe.diameter = 14.5e-3;  // 10 ml
  params.syringe.break_loose = params.syringe.glide;
  params.needle = *bore_of_gauge(25, 0.038);
  Plunger plunger(params, one_space(compliance(kRest, 1 / kCompliance)), 1e-3);
  const double force = params.syringe.glide + params.syringe.area() * (kRest + 50 * kMercury);
  constexpr std::array<OracleRow, 4> kRows{{{1, 0.0001657184133, 1.96323996e-08, 7732.676},
                                            {20, 0.002328621056, 3.767924349e-07, 7732.676},
                                            {100, 0.009698601736, 1.593797078e-06, 7732.676},
                                            {200, 0.01593193808, 2.623107684e-06, 7732.676}}};
  expect_rows(
      plunger, 1e-3, kRows, [&](double) { return force; }, 1e-7);
}

TEST(PlungerOracle, AStoppedPlungerOfASoftBarrelFlowsOnAlike) {
  PlungerParams params = water_syringe(0);
  params.syringe.compliance = kAirAtRest;
  params.syringe.break_loose = 7;
  params.syringe.glide = 0;
  Plunger plunger(params, one_space(compliance(0, 1 / kCompliance)), 1e-4);
  constexpr std::array<OracleRow, 5> kRows{{{0.05, 0.001211012115, 4.195882355e-08, 48826.72731},
                                            {0.1, 0.001211012115, 7.115379888e-08, 34035.82294},
                                            {0.2, 0.001211012115, 1.056020923e-07, 16583.4563},
                                            {0.5, 0.001211012115, 1.342632739e-07, 2062.985174},
                                            {1, 0.001211012115, 1.378344011e-07, 253.7628145}}};
  expect_rows(
      plunger, 1e-4, kRows, [](double t) { return t < 1.5e-4 ? 8.0 : 4.0; }, 1e-7);
}

TEST(PlungerOracle, ResistanceIsLostAlikeAtConstantForce) {
  struct Needle {
    int gauge;
    double length;
    double before;  // m^3/s in 20 kPa
    double after;   // m^3/s in 20 mmHg
    double travel;  // m, after 0.3 s
    double given;   // m^3
  };
  constexpr std::array<Needle, 2> kNeedles{
      {{22, 0.05, 1.846226491e-07, 3.529566383e-07, 0.001086133948, 8.905359257e-08},
       {18, 0.04, 1.631482009e-06, 2.568774958e-06, 0.006232275525, 6.769031925e-07}}};
  for (const Needle& row : kNeedles) {
    PlungerParams params = water_syringe();
    params.needle = *bore_of_gauge(row.gauge, row.length);
    std::vector<Space> spaces = one_space(level(20e3), "muscle");
    spaces.push_back(one_space(level(20 * kMercury), "bursa")[0]);
    Plunger plunger(params, spaces, 1e-3);
    PlungerInput input = thumb(6);
    for (int k = 1; k <= 300; ++k) {
      if (k == 101) input.tip[0].space = 1;
      plunger.step(input);
      const double flow = k <= 100 ? row.before : row.after;
      ASSERT_NEAR(plunger.state().flow / flow, 1, 1e-3) << row.gauge << ' ' << k;
    }
    const double given = plunger.states()[0].volume + plunger.states()[1].volume;
    EXPECT_NEAR(given / row.given, 1, 1e-3) << row.gauge;
    EXPECT_NEAR(plunger.state().travel / row.travel, 1, 1e-3) << row.gauge;
  }
}

TEST(PlungerOracle, ResistanceIsLostOrGainedAlikeAtAConstantRate) {
  struct Row {
    double diameter;  // m, of the barrel
    double from;      // Pa
    double to;        // Pa
    double fall;      // N at the thumb
  };
  // Area times step of pressure: tendon to bursa, muscle to bursa, beside a nerve into it.
  constexpr std::array<Row, 6> kRows{{{0.01206, 300e3, 20 * kMercury, 33.964750},
                                      {0.01206, 20e3, 20 * kMercury, 1.980032},
                                      {0.01206, 6 * kPsi, 25 * kPsi, -14.964323},
                                      {0.0145, 300e3, 20 * kMercury, 49.098680},
                                      {0.0145, 20e3, 20 * kMercury, 2.862290},
                                      {0.0145, 6 * kPsi, 25 * kPsi, -21.632089}}};
  for (const Row& row : kRows) {
    PlungerParams params = water_syringe();
    params.syringe.diameter = row.diameter;
    std::vector<Space> spaces = one_space(level(row.from), "from");
    spaces.push_back(one_space(level(row.to), "to")[0]);
    Plunger plunger(params, spaces, 1e-3);
    PlungerInput input = thumb(0);
    input.stiffness = 2000;
    const double speed = 1e-7 / params.syringe.area();
    const double ahead = (params.syringe.area() * row.from + 4) / input.stiffness;
    double before = 0;
    // 10 ml at this rate take 18 s to press 21.6 N into the spring; 40 s are enough for all.
    for (int k = 0; k < 60000; ++k) {
      if (k == 20000) {
        before = plunger.state().force;
        input.tip[0].space = 1;
      }
      input.position = ahead + speed * 1e-3 * k;
      plunger.step(input);
    }
    EXPECT_NEAR((before - plunger.state().force) / row.fall, 1, 2e-3) << row.diameter << row.from;
  }
}

TEST(PlungerOracle, TheThumbsWorkIsSpentAlike) {
  constexpr double kDt = 1e-4;
  PlungerParams params = water_syringe(0);
  Plunger plunger(params, one_space(compliance(kRest, 1 / kCompliance)), kDt);
  const double force = 4 + params.syringe.area() * (kRest + 50 * kMercury);
  const double resistance =
      NeedleFlow(params.needle, params.liquid.viscosity, params.liquid.density, 0).resistance();
  double needle = 0;
  for (int k = 0; k < 50000; ++k) {
    const double flow = plunger.step(thumb(force)).flow;
    needle += flow * flow * resistance * kDt;
  }
  const double travel = plunger.state().travel;
  const double volume = plunger.states()[0].volume;
  const double pressure = plunger.state().pressure;
  EXPECT_NEAR(force * travel / 0.07110518081, 1, 1e-3);
  EXPECT_NEAR(params.syringe.glide * travel / 0.02912170079, 1, 1e-3);
  EXPECT_NEAR(needle / 0.03761187263, 1, 1e-3);
  EXPECT_NEAR((kRest * volume + volume * volume / (2 * kCompliance)) / 0.003734537203, 1, 1e-3);
  EXPECT_NEAR(params.syringe.softness() * pressure * pressure / 0.0006371099612, 1, 1e-3);
}

TEST(PlungerOracle, TheHandsTableIsReproduced) {
  struct Target {
    const char* name;
    double pressure;
    std::array<double, 8> force;  // N: 18, 21, 22 G and 25 G of 38 mm, each at 0.1 and 0.3 ml/s
  };
  constexpr std::array<Target, 7> kTargets{
      {{"open air", 0, {0.0419, 0.1504, 0.3626, 1.2628, 0.8699, 3.0297, 4.3160, 15.6225}},
       {"bursa", 20 * kMercury, {0.3465, 0.4550, 0.6672, 1.5674, 1.1745, 3.3343, 4.6206, 15.9271}},
       {"muscle", 20e3, {2.3265, 2.4351, 2.6472, 3.5475, 3.1545, 5.3143, 6.6006, 17.9071}},
       {"perineural", 6 * kPsi, {4.7675, 4.8760, 5.0882, 5.9884, 5.5955, 7.7553, 9.0416, 20.3481}},
       {"capsulitis",
        300 * kMercury,
        {4.6107, 4.7193, 4.9314, 5.8317, 5.4387, 7.5986, 8.8848, 20.1914}},
       {"intraneural",
        25 * kPsi,
        {19.7318, 19.8403, 20.0525, 20.9527, 20.5598, 22.7196, 24.0059, 35.3124}},
       {"tendon",
        300e3,
        {34.3112, 34.4198, 34.6319, 35.5322, 35.1392, 37.2991, 38.5853, 49.8918}}}};
  constexpr std::array<std::pair<int, double>, 4> kNeedles{
      {{18, 0.04}, {21, 0.05}, {22, 0.05}, {25, 0.038}}};
  for (const Target& target : kTargets) {
    for (std::size_t k = 0; k < 8; ++k) {
      PlungerParams params = water_syringe();
      params.needle = *bore_of_gauge(kNeedles[k / 2].first, kNeedles[k / 2].second);
      Plunger plunger(params, one_space(level(target.pressure)), 1e-3);
      const double rate = k % 2 == 0 ? 1e-7 : 3e-7;
      PlungerInput input = thumb(0);
      input.stiffness = 2000;
      double force = 0;
      // Up to the pressure at once, then at the rate until nothing changes.
      const double ahead = (target.force[k] + 2) / input.stiffness;
      for (int i = 0; i < 20000; ++i) {
        input.position = ahead + rate / params.syringe.area() * 1e-3 * i;
        force = plunger.step(input).force;
      }
      EXPECT_NEAR(plunger.state().flow / rate, 1, 5e-3) << target.name << ' ' << k;
      EXPECT_NEAR(force - params.syringe.glide, target.force[k], 0.02 * target.force[k] + 1e-3)
          << target.name << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace artus
