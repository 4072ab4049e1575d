// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/injecting_device.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

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
  explicit Loop(bool feel, double volume = 0)
      : feel_(feel), device_(plan_into_the_bursa(volume), params_.device, kRate) {}
  const HapticSnapshot& step() {
    TickInput input;
    input.tick = ++tick_;
    input.device = device_.read(static_cast<std::int64_t>(tick_) * 1'000'000);
    const HapticSnapshot& out = core_.step(input);
    DeviceFeedback feedback = out.feedback;
    if (!feel_) std::fill(std::begin(feedback.force), std::end(feedback.force), 0.0);
    device_.write(feedback);
    return out;
  }
  [[nodiscard]] InjectingDevice::Phase phase() const { return device_.phase(); }

 private:
  bool feel_;
  std::shared_ptr<const Scene> scene_ = test::make_layered_scene();
  SessionParams params_ = test::make_small_session();
  HapticCore core_{scene_, params_};
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

TEST(InjectingDevice, GivesWhatIsMeantAndNotWhatItsBarrelHoldsMore) {
  Loop loop(true, 0.1e-6);
  double given = 0;
  for (int i = 0; i < 12000; ++i) {
    const HapticSnapshot& out = loop.step();
    if (loop.phase() == InjectingDevice::Phase::rest) given = out.feedback.plunger.given;
    if (loop.phase() > InjectingDevice::Phase::rest) break;
  }
  EXPECT_EQ(loop.phase(), InjectingDevice::Phase::to_bone);
  EXPECT_NEAR(given, 0.1e-6, 0.01e-6)  // fitted
      << "0.118 ml when the thumb lets go at the mark";
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
