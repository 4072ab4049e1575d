// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/haptic_loop.h"

#include <memory>

#include <gtest/gtest.h>

#include "artus/simulation/simulation.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

// A needle that goes in at 20 mm/s and keeps what it was last told.
class SteadyDevice final : public InputDevice {
 public:
  DeviceSample read(std::int64_t now_ns) noexcept override {
    if (number == 0) start = now_ns;
    DeviceSample sample;
    const double t = 1e-9 * static_cast<double>(now_ns - start);
    sample.X_WN = to_plain(make_pose(Vec3(0, 0, -0.001 + 0.02 * t), Vec3::UnitZ(), Vec3::UnitX()));
    sample.time_ns = now_ns;
    sample.number = ++number;
    sample.state = PeerState::alive;
    sample.has_needle = 1;
    return sample;
  }
  void write(const DeviceFeedback& feedback) noexcept override { last = feedback; }
  std::string_view name() const noexcept override { return "steady"; }

  DeviceFeedback last;
  std::uint64_t number = 0;
  std::int64_t start = 0;
};

std::shared_ptr<const Scene> block() {
  const std::vector<test::FlatLayer> layers{{"skin", 0.003}, {"muscle", 0.04}, {"bone", 0.02}};
  return std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 0.2, 0.2)));
}

SessionParams params_at(double rate) {
  SessionParams params;
  params.device = find_device("virtuose_6d_desktop").value();
  params.haptic_rate = rate;
  return params;
}

TEST(LateWatch, OneLateTickIsNoReasonARowOfThemIs) {
  constexpr std::int64_t kPeriod = 1'000'000;
  LateWatch watch(kPeriod);
  EXPECT_FALSE(watch.step(15 * kPeriod)) << "one long gap";
  EXPECT_FALSE(watch.step(0));
  int ticks = 0;
  while (!watch.step(kPeriod) && ticks < 1000) ++ticks;
  EXPECT_NEAR(ticks, LateWatch::kTooLong / (2 * kPeriod), 1);
  EXPECT_TRUE(watch.step(kPeriod)) << "until one is on time";
  EXPECT_FALSE(watch.step(kPeriod - 1));
  EXPECT_FALSE(watch.step(kPeriod));
}

TEST(HapticLoop, TicksAtItsRateCountsThemAndLeavesWithZeroForce) {
  Simulation core(block(), params_at(1000));
  SteadyDevice device;
  Seqlock<HapticSnapshot> newest;
  const auto compute = std::make_unique<LatencyHistogram>();
  const auto cpu = std::make_unique<LatencyHistogram>();
  const auto lateness = std::make_unique<LatencyHistogram>();
  std::uint64_t overruns = 0;
  const std::int64_t begin = monotonic_ns();
  constexpr std::uint64_t kTicks = 200;
  {
    HapticLoop loop(core, device, 1000, newest, {*compute, *cpu, *lateness});
    while (loop.ticks() < kTicks) {
      loop.wait();
      loop.step(0);
    }
    overruns = loop.overruns();
  }
  EXPECT_GE(monotonic_ns() - begin, 190'000'000) << "never faster than its rate";
  EXPECT_EQ(device.number, kTicks);
  EXPECT_LE(overruns, kTicks);
  EXPECT_EQ(compute->count(), kTicks);
  EXPECT_EQ(cpu->count(), kTicks);
  EXPECT_GE(lateness->count(), kTicks);
  HapticSnapshot snapshot;
  ASSERT_TRUE(newest.load(snapshot));
  EXPECT_EQ(snapshot.input.tick, kTicks);
  EXPECT_EQ(device.last.status, SessionStatus::kStopped);
  for (const double f : device.last.force) EXPECT_EQ(f, 0);
}

TEST(Simulation, ALoopThatIsLateForTooLongGivesNoForceAndComesBackByTheRamp) {
  Simulation core(block(), params_at(1000));
  SteadyDevice device;
  const auto tick = [&](std::int64_t ms, std::uint32_t command) {
    TickInput input;
    input.device = device.read(1'000'000'000 + ms * 1'000'000);
    input.command = command;
    const HapticSnapshot& out = core.tick(input);
    return std::pair(std::abs(out.feedback.force[2]), out.status);
  };
  double before = 0;
  for (std::int64_t ms = 0; ms < 600; ++ms) before = tick(ms, 0).first;
  EXPECT_GT(before, 1);
  const auto [late, status] = tick(600, SessionCommand::kLate);
  EXPECT_EQ(late, 0);
  EXPECT_NE(status & TickStatus::kLate, 0U);
  double last = 0;
  for (std::int64_t ms = 601; ms < 1200; ++ms) {
    const double force = tick(ms, 0).first;
    EXPECT_LE(force, last + GuardParams{}.force_slew * 1e-3);
    last = force;
  }
  EXPECT_GT(last, 1);
}

}  // namespace
}  // namespace artus
