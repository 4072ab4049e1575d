// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/backstepping_law.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kMass = 0.37;

TEST(StiffnessGains, GiveTheWantedStiffnessAndDampingBack) {
  for (const double k : {1.0, 500.0, 800.0, 3000.0, 80000.0}) {
    for (const double factor : {1.0, 1.05, 3.0}) {
      const double b = factor * min_closed_loop_damping(kMass, k);
      const auto gains = find_stiffness_gains(kMass, k, b);
      ASSERT_TRUE(gains);
      EXPECT_NEAR(closed_loop_stiffness(kMass, gains->c_1, gains->c_2), k, 1e-9 * k);
      EXPECT_NEAR(kMass * (gains->c_1 + gains->c_2), b, 1e-9 * b);
      EXPECT_GE(gains->c_1, gains->c_2);
      EXPECT_GT(gains->c_2, 0);
    }
  }
}

TEST(StiffnessGains, RefuseWhatIsNotStable) {
  EXPECT_FALSE(find_stiffness_gains(kMass, kMass, 100));
  EXPECT_FALSE(find_stiffness_gains(kMass, 0.1, 100));
  EXPECT_FALSE(find_stiffness_gains(kMass, -5, 100));
  EXPECT_FALSE(find_stiffness_gains(kMass, 800, 0.999 * min_closed_loop_damping(kMass, 800)));
  EXPECT_FALSE(find_stiffness_gains(kMass, std::nan(""), 100));
  EXPECT_FALSE(find_stiffness_gains(kMass, 800, std::nan("")));
}

TEST(StiffnessGains, PrintedGainsMeanAStiffnessFarAboveThePublishedProfile) {
  const BacksteppingGains printed;
  EXPECT_NEAR(closed_loop_stiffness(kMass, printed.c_1, printed.c_2), 80808, 1);
}

/// The continuous closed loop: rod without unknown force, chambers that get exactly the wanted
/// active flow. Integrated far finer than any of its time constants.
class ExactLoop {
 public:
  explicit ExactLoop(const ControlParams& control) : law_(control, params_, map_, false) {
    ControlInput input;
    law_.reset(input);
    dt_ = 1 / control.rate;
  }

  PneumaticParams params_;
  ValveMap map_{params_.valve, params_.cylinder};
  BacksteppingLaw law_;
  CylinderState state_{0.004, 0, 3e5, 3e5};
  ProbeTarget target_;
  double dt_;

  /// One tick; the law's own step keeps the integral of z_3.
  void step() {
    const CylinderParams& c = params_.cylinder;
    ControlInput input;
    input.measured = {state_.y, state_.p_P, state_.p_N, 0};
    input.v = state_.v;
    input.target = target_;
    static_cast<void>(law_.step(input));
    const double q_A = law_.active_flow(state_, target_);
    const PressureRates rates = pressure_rates(c, state_, to_chambers(c, state_.y, {q_A, 0}));
    const double force = pneumatic_force(c, state_);
    const double a =
        (force - c.viscous_friction * state_.v - c.moving_mass * kGravity) / c.moving_mass;
    state_.y += dt_ * state_.v;
    state_.v += dt_ * a;
    state_.p_P += dt_ * rates.dp_P;
    state_.p_N += dt_ * rates.dp_N;
  }
};

TEST(BacksteppingLaw, LyapunovFunctionNeverRisesInTheNominalCase) {
  for (const double stiffness : {500.0, 800.0, 3000.0}) {
    ControlParams control;
    control.rate = 2e6;
    ExactLoop loop(control);
    loop.target_.stiffness = stiffness;
    loop.step();
    double last = loop.law_.errors().lyapunov(control.backstepping.k_3i);
    const double first = last;
    for (int i = 0; i < 400000; ++i) {
      loop.step();
      const double now = loop.law_.errors().lyapunov(control.backstepping.k_3i);
      ASSERT_LE(now, last + 1e-6 * first) << "tick " << i << " at " << stiffness;
      last = now;
    }
    EXPECT_LT(last, 1e-3 * first);
  }
}

TEST(BacksteppingLaw, ErrorsObeyTheRecursionOfTheDesign) {
  // dz_1 = z_2 - C_1 z_1 and dz_2 = z_3/M - z_1 - C_2 z_2, (3.25) and (3.30).
  ControlParams control;
  control.rate = 1e7;
  ExactLoop loop(control);
  loop.target_.stiffness = 2000;
  for (int i = 0; i < 20000; ++i) loop.step();
  const BacksteppingErrors before = loop.law_.errors();
  loop.step();
  const BacksteppingErrors after = loop.law_.errors();
  const BacksteppingGains& g = loop.law_.gains();
  const double dz_1 = (after.z_1 - before.z_1) * control.rate;
  const double dz_2 = (after.z_2 - before.z_2) * control.rate;
  EXPECT_NEAR(dz_1, before.z_2 - g.c_1 * before.z_1, 1e-3 * std::abs(dz_1));
  EXPECT_NEAR(dz_2, before.z_3 / kMass - before.z_1 - g.c_2 * before.z_2, 1e-3 * std::abs(dz_2));
  const double dz_3 = (after.z_3 - before.z_3) * control.rate;
  const double designed = -before.z_2 / kMass - g.c_3 * before.z_3 - g.k_3i * before.z_3i;
  EXPECT_NEAR(dz_3, designed, 5e-3 * std::abs(dz_3) + 1e-3);
}

/// Least-squares slope of y over x.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xx = 0;
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xy / xx;
}

/// Pushes the rod in slowly through the whole simulated mock and returns the slope of force over
/// displacement, N/m.
double measured_stiffness(ControlLawKind kind, double stiffness, bool noise) {
  PneumaticParams params;
  if (!noise) {
    params.sensors.pressure.noise = params.sensors.position.noise = params.sensors.force.noise = 0;
    params.sensors.pressure.step = params.sensors.position.step = params.sensors.force.step = 0;
  }
  const ControlParams control;
  const ValveMap map(params.valve, params.cylinder);
  PneumaticPlant plant(params, ValveLayout::two);
  ProbeSensors sensors(params.sensors, 3);
  const auto law = make_control_law(kind, control, params, map);
  const double dt = 1 / control.rate;
  const double push_time = 8;
  const double friction = params.cylinder.dry_friction;
  const double top = std::min(22.0, friction + 0.012 * stiffness);
  double last_y = 0;
  double v = 0;
  std::vector<double> displacement;
  std::vector<double> force;
  for (int i = 0; i < static_cast<int>((push_time + 0.5) / dt); ++i) {
    const double t = i * dt - 0.5;
    ControlInput input;
    input.measured = sensors.read(plant);
    v += 0.17 * ((input.measured.y - last_y) / dt - v);
    last_y = input.measured.y;
    input.v = v;
    input.target.stiffness = stiffness;
    if (i == 0) law->reset(input);
    RodLoad load;
    load.force = t > 0 ? top * t / push_time : 0;
    plant.step(law->step(input).command, load, dt);
    if (load.force < friction + 0.1 * (top - friction)) continue;  // beyond it the rod slides
    displacement.push_back(-plant.state().y);
    force.push_back(load.force);
  }
  return slope(displacement, force);
}

TEST(BacksteppingLaw, QuasiStaticPushMeasuresTheClosedLoopStiffnessOverItsValidRange) {
  // From the least stiffness that its stroke lets a hand feel beyond dry friction to the printed
  // gains' 80.8 kN/m.
  for (const double stiffness : {100.0, 200.0, 400.0, 800.0, 3000.0, 8000.0, 25000.0, 80808.0}) {
    const double measured =
        measured_stiffness(ControlLawKind::backstepping_one_valve, stiffness, false);
    EXPECT_NEAR(measured, stiffness, 0.05 * stiffness);
  }
}

TEST(BacksteppingLaw, SensorNoiseDoesNotChangeTheStiffness) {
  for (const double stiffness : {800.0, 3000.0}) {
    const double measured =
        measured_stiffness(ControlLawKind::backstepping_one_valve, stiffness, true);
    EXPECT_NEAR(measured, stiffness, 0.05 * stiffness);
  }
}

TEST(BacksteppingLaw, TwoValvesGiveTheSameStiffness) {
  for (const double stiffness : {800.0, 3000.0}) {
    const double measured =
        measured_stiffness(ControlLawKind::backstepping_two_valves, stiffness, false);
    EXPECT_NEAR(measured, stiffness, 0.05 * stiffness);
  }
}

TEST(BacksteppingLaw, TwoValvesHoldThePneumaticStiffnessToo) {
  const PneumaticParams params;
  const ControlParams control;
  const ValveMap map(params.valve, params.cylinder);
  for (const double wanted : {1500.0, 2500.0}) {
    PneumaticPlant plant(params, ValveLayout::two);
    ProbeSensors sensors(params.sensors, 3);
    const auto law =
        make_control_law(ControlLawKind::backstepping_two_valves, control, params, map);
    double last_y = 0;
    double v = 0;
    for (int i = 0; i < 10000; ++i) {
      ControlInput input;
      input.measured = sensors.read(plant);
      v += 0.17 * ((input.measured.y - last_y) * control.rate - v);
      last_y = input.measured.y;
      input.v = v;
      input.target.pneumatic = wanted;
      if (i == 0) law->reset(input);
      plant.step(law->step(input).command, {}, 1 / control.rate);
    }
    EXPECT_NEAR(pneumatic_stiffness(params.cylinder, plant.state()), wanted, 0.02 * wanted);
    EXPECT_LT(std::abs(plant.state().y), 3e-3);
  }
}

TEST(BacksteppingLaw, KnownForceDoesNotMoveTheRod) {
  const PneumaticParams params;
  const ControlParams control;
  const ValveMap map(params.valve, params.cylinder);
  PneumaticPlant plant(params, ValveLayout::one);
  ProbeSensors sensors(params.sensors, 3);
  const auto law = make_control_law(ControlLawKind::backstepping_one_valve, control, params, map);
  double last_y = 0;
  double v = 0;
  for (int i = 0; i < 20000; ++i) {
    ControlInput input;
    input.measured = sensors.read(plant);
    v += 0.17 * ((input.measured.y - last_y) * control.rate - v);
    last_y = input.measured.y;
    input.v = v;
    RodLoad load;
    load.force = std::min(10.0, i * 1e-3);
    input.target.known_force = load.force;
    if (i == 0) law->reset(input);
    plant.step(law->step(input).command, load, 1 / control.rate);
  }
  EXPECT_LT(std::abs(plant.state().y), 0.1e-3);
}

TEST(BacksteppingLaw, RefusedTargetKeepsTheLastGains) {
  const PneumaticParams params;
  const ValveMap map(params.valve, params.cylinder);
  BacksteppingLaw law(ControlParams{}, params, map, false);
  ControlInput input;
  input.measured = {0, 3e5, 3e5, 0};
  law.reset(input);
  const double c_1 = law.gains().c_1;
  for (const double stiffness : {0.1, 99.0}) {
    input.target.stiffness = stiffness;
    EXPECT_TRUE(law.step(input).target_refused);
    EXPECT_EQ(law.gains().c_1, c_1);
  }
  input.target.stiffness = kMinFeltStiffness;
  EXPECT_FALSE(law.step(input).target_refused);
}

}  // namespace
}  // namespace artus
