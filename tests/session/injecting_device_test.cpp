// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/injecting_device.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "artus/simulation/simulation.h"
#include "tests/session/session_support.h"
#include "tests/support/no_alloc.h"

namespace artus {
namespace {

constexpr double kRate = 1000;  // Hz

InjectionPlan plan_into_the_bursa(double volume) {
  InjectionPlan plan;
  plan.volume = volume;
  plan.X_WP = make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX());
  plan.target = 23e-3;  // the bursa lies between 22 and 24 mm, bone at 29 mm
  plan.deepest = 40e-3;
  plan.speed = 20e-3;
  return plan;
}

/// The device in a closed loop with the session's haptic core.
class Loop {
 public:
  explicit Loop(bool feel) : Loop(feel, plan_into_the_bursa(0), {}) {}
  Loop(bool feel, InjectionPlan plan, const SyringeChoice& syringe)
      : feel_(feel), params_(with(syringe)), device_(meant(plan), params_.device, kRate) {}
  const HapticSnapshot& step() {
    TickInput input;
    input.tick = ++tick_;
    input.device = device_.read(static_cast<std::int64_t>(tick_) * 1'000'000);
    const HapticSnapshot& out = core_.tick(input);
    DeviceFeedback feedback = out.feedback;
    if (!feel_) std::fill(std::begin(feedback.force), std::end(feedback.force), 0.0);
    device_.write(feedback);
    return out;
  }
  [[nodiscard]] InjectingDevice::Phase phase() const { return device_.phase(); }

 private:
  static SessionParams with(const SyringeChoice& syringe) {
    SessionParams params = test::make_small_session();
    params.syringe = syringe;
    return params;
  }
  [[nodiscard]] InjectionPlan meant(InjectionPlan plan) const {
    plan.plunger = core_.syringe().plunger().params();
    return plan;
  }

  bool feel_;
  SessionParams params_;
  std::shared_ptr<const Scene> scene_ = test::make_layered_scene();
  Simulation core_{scene_, params_};
  InjectingDevice device_;
  std::uint64_t tick_ = 0;
};

TEST(InjectingDevice, BoneStopsTheHandWhichTurnsBack) {
  Loop loop(true);
  double deepest = 0;
  double strongest = 0;
  std::set<std::uint32_t> regions;
  bool pressed = false;
  for (int i = 0; i < 8000; ++i) {
    const HapticSnapshot& out = loop.step();
    deepest = std::max(deepest, out.feedback.depth);
    strongest = std::max(strongest, -out.feedback.force[2]);
    regions.insert(out.feedback.region);
    pressed = pressed || loop.phase() == InjectingDevice::Phase::press;
  }
  EXPECT_TRUE(pressed);
  EXPECT_GE(regions.size(), 6U) << "outside and five soft layers";
  EXPECT_LT(deepest, 33e-3) << "bone begins at 29 mm";
  EXPECT_GT(strongest, 3.5) << "and pushes back";
}

TEST(InjectingDevice, WithoutForceTheNeedleGoesWhereBoneWouldHaveStoppedIt) {
  Loop loop(false);
  double deepest = 0;
  for (int i = 0; i < 6000; ++i) deepest = std::max(deepest, loop.step().feedback.depth);
  EXPECT_GT(deepest, 33e-3) << "the loop is really closed";
}

TEST(InjectingDevice, ComesOutAndBeginsAgain) {
  Loop loop(true);
  int injections = 0;
  bool inside = false;
  for (int i = 0; i < 14000; ++i) {
    const bool now = loop.step().inserted != 0;
    if (now && !inside) ++injections;
    inside = now;
  }
  EXPECT_GE(injections, 2);
}

/// m^3 that are out once the hand has let go of the plunger and drawn the needle out.
double given_of(double volume, double rate, const SyringeChoice& syringe) {
  InjectionPlan plan = plan_into_the_bursa(volume);
  plan.rate = rate;
  Loop loop(true, plan, syringe);
  double given = 0;
  for (int i = 0; i < 100000 && loop.phase() != InjectingDevice::Phase::withdraw; ++i)
    given = loop.step().feedback.plunger.given;
  EXPECT_EQ(loop.phase(), InjectingDevice::Phase::withdraw);
  return given;
}

TEST(InjectingDevice, GivesWhatIsMeant) {
  struct Dose {
    double volume;  // m^3
    double rate;    // m^3/s
    double filled;  // m^3
  };
  for (const Dose& d :
       {Dose{0.1e-6, 0.1e-6, 1e-6}, Dose{0.1e-6, 0.25e-6, 5e-6}, Dose{0.5e-6, 0.25e-6, 1e-6},
        Dose{1e-6, 0.25e-6, 2.5e-6}, Dose{5e-6, 0.25e-6, 6e-6}, Dose{10e-6, 0.4e-6, 12e-6},
        Dose{20e-6, 0.8e-6, 22e-6}}) {
    SyringeChoice syringe;
    syringe.filled = d.filled;
    EXPECT_NEAR(given_of(d.volume, d.rate, syringe) / d.volume, 1, 0.02)
        << d.volume << " by a barrel of " << d.filled;
  }
  for (const int gauge : {18, 25, 27}) {
    SyringeChoice syringe;
    syringe.gauge = gauge;
    EXPECT_NEAR(given_of(1e-6, 0.1e-6, syringe) / 1e-6, 1, 0.02) << gauge;
  }
}

TEST(InjectingDevice, ReadAndWriteDoNotAllocate) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP() << "no allocation counter in this build";
  Loop loop(true);
  loop.step();
  const test::AllocationCounter counter;
  for (int i = 0; i < 4000; ++i) loop.step();
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace artus
