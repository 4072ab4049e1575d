// SPDX-License-Identifier: AGPL-3.0-or-later
// What a broken device can send never becomes an unsafe force.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/haptics/needle_renderer.h"
#include "tests/haptics/needle/block_stroke.h"
#include "tests/support/broken_device.h"
#include "tests/support/trials.h"

namespace artus {
namespace {

using test::broken;
using test::Bursts;
using test::Fault;

constexpr double kTick = 1e-3;
constexpr std::uint64_t kSeed = 5;
constexpr std::uint64_t kManyTicks = test::trials(1'000'000);

TEST(NeedleFaults, NeverGetAnUnsafeForceOutOverAMillionTicks) {
  const auto scene = test::block();
  NeedleRendererParams params;
  params.guard.workspace_half = Vec3::Constant(0.25);
  params.device = find_device("virtuose_6d_desktop").value();
  params.rate_hz = 1 / kTick;
  const GuardParams& guard = params.guard;
  const DeviceLimits& device = params.device;
  NeedleRenderer renderer(scene, make_layer_table(scene->joint()), params);
  std::array<long, 32> seen{};
  Wrench last;
  double since_fault = 0;
  long felt = 0, recoveries = 0;
  double fullest = 0;
  Bursts bursts{kSeed};
  TimedPose before;
  for (std::uint64_t i = 0; i < kManyTicks; ++i) {
    const double t = kTick * static_cast<double>(i);
    const Fault fault = bursts.at(i);
    const TimedPose sane = test::stroke(t);
    if (!bursts.faulty) before = sane;
    const RenderedNeedle& out = renderer.step(broken(fault, kSeed, i, sane, before));
    for (std::size_t bit = 0; bit < seen.size(); ++bit) seen[bit] += (out.status >> bit) & 1U;
    ASSERT_TRUE(out.command.force.allFinite() && out.command.torque.allFinite()) << i;
    ASSERT_TRUE(std::isfinite(out.energy_to_hand)) << i;
    if ((out.status & TickStatus::kFaults) != 0) {
      ASSERT_EQ(out.command.force.norm(), 0) << "not zero in the tick of the fault, " << i;
      ASSERT_EQ(out.command.torque.norm(), 0) << i;
      since_fault = 0;
      last = Wrench{};
      continue;
    }
    // What no guard can tell from a hand: a clock or a place that was already refused once.
    const bool may_pass = fault == Fault::none || fault == Fault::frozen ||
                          fault == Fault::teleport || fault == Fault::reversed;
    ASSERT_TRUE(may_pass) << i;
    since_fault += kTick;
    const double ramp = std::min(1.0, since_fault / guard.ramp_time);
    ASSERT_LE(out.command.force.norm(), ramp * device.force * (1 + 1e-9)) << i;
    ASSERT_LE(out.command.torque.norm(), ramp * device.torque * (1 + 1e-9)) << i;
    ASSERT_LE((out.command.force - last.force).norm(), guard.force_slew * kTick * (1 + 1e-9)) << i;
    ASSERT_LE((out.command.torque - last.torque).norm(), guard.torque_slew * kTick * (1 + 1e-9))
        << i;
    last = out.command;
    if (std::abs(since_fault - guard.ramp_time) < 0.5 * kTick) ++recoveries;
    if (out.command.force.norm() > 0.5) ++felt;
    fullest = std::max(fullest, out.command.force.norm());
  }
  const auto of = [&seen](std::uint32_t bit) {
    return seen[static_cast<std::size_t>(std::countr_zero(bit))];
  };
  for (const std::uint32_t bit :
       {TickStatus::kNotFinite, TickStatus::kNotRigid, TickStatus::kTeleport,
        TickStatus::kTimeReversed, TickStatus::kStale, TickStatus::kOutOfWorkspace}) {
    EXPECT_GT(of(bit), test::trials(500)) << "bit " << bit << " must be met";
  }
  EXPECT_GT(recoveries, test::trials(500)) << "bursts after which the ramp came to its end";
  EXPECT_GT(felt, test::trials(200'000));
  EXPECT_GT(fullest, 3) << "full forces are met between the faults";
}

/// Points along the track that each give way and take their neighbours along.
NeedleCompliance giving_way(double scale) {
  NeedleCompliance c;
  c.points = NeedleCompliance::kMax;
  for (std::size_t i = 0; i < c.points; ++i) {
    for (std::size_t j = 0; j < c.points; ++j) {
      const double apart = std::abs(static_cast<double>(i) - static_cast<double>(j));
      c.by_load[i][j] = scale * (i == j ? 1.6e-3 : 0.9e-3 * std::exp(-0.25 * apart));
    }
  }
  return c;
}

/// The same in tissue that gives way, another one every half second. What the faults leave behind
/// must be gone once the needle is out.
TEST(NeedleFaults, InTissueThatGivesWayLeaveForcesInLimitsAndTheTissueAtRest) {
  NeedleRendererParams params;
  params.guard.workspace_half = Vec3::Constant(0.25);
  params.device = find_device("virtuose_6d_desktop").value();
  params.rate_hz = 1 / kTick;
  const auto scene = test::block();
  NeedleRenderer renderer(scene, make_layer_table(scene->joint()), params);
  const NeedleCoupling& tissue = renderer.model().coupling();
  long felt = 0;
  long faults = 0;
  double deepest = 0;
  Bursts bursts{kSeed};
  TimedPose before;
  constexpr std::uint64_t kTicks = 100'000;
  for (std::uint64_t i = 0; i < kTicks; ++i) {
    if (i % 500 == 0) renderer.take({{}, giving_way(0.3 + 2 * uniform_noise(kSeed + 20, i))});
    const Fault fault = bursts.at(i);
    const TimedPose sane = test::stroke(kTick * static_cast<double>(i));
    if (!bursts.faulty) before = sane;
    const RenderedNeedle& out = renderer.step(broken(fault, kSeed, i, sane, before));
    ASSERT_TRUE(out.command.force.allFinite() && out.command.torque.allFinite()) << i;
    ASSERT_TRUE(std::isfinite(out.energy_to_hand + tissue.stored() + tissue.dissipated())) << i;
    ASSERT_LE(out.command.force.norm(), params.device.force * (1 + 1e-9)) << i;
    ASSERT_LE(out.command.torque.norm(), params.device.torque * (1 + 1e-9)) << i;
    ASSERT_LT(std::abs(tissue.tip_displacement()), 0.05) << i;
    deepest = std::max(deepest, tissue.tip_displacement());
    if (out.command.force.norm() > 0.5) ++felt;
    if ((out.status & TickStatus::kFaults) != 0) ++faults;
  }
  EXPECT_GT(felt, 20'000);
  EXPECT_GT(faults, 1000);
  EXPECT_GT(deepest, 1e-3) << "the tissue gave way between the faults";
  TimedPose away = test::stroke(0);
  for (std::uint64_t i = 0; i < 2000; ++i) {
    away.time = kTick * static_cast<double>(kTicks + 3000 + i);
    static_cast<void>(renderer.step(away));
  }
  EXPECT_FALSE(renderer.model().contact().inserted());
  EXPECT_LT(std::abs(tissue.tip_displacement()), 1e-7);
  EXPECT_EQ(tissue.stored(), 0);
  EXPECT_EQ(renderer.step({away.X_JN, away.time + kTick}).command.force.norm(), 0);
}

}  // namespace
}  // namespace artus
