// SPDX-License-Identifier: AGPL-3.0-or-later
// What needle and probe share, under the allocation and lock counters.
#include <limits>

#include <gtest/gtest.h>

#include "artus/detail/haptics/guard.h"
#include "artus/detail/haptics/passivity.h"
#include "artus/haptics/device.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

using test::use;

constexpr double kPeriod = 1e-3;  // s

TEST(RealTimeHaptics, LimitsOfADeviceNeitherAllocateNorLock) {
  const DeviceLimits device = *find_device("virtuose_6d_desktop");
  const Wrench strong{Vec3(100, 0, 0), Vec3(0, 10, 0)};
  Wrench limited;
  ARTUS_RUNS_REALTIME(saturate, limited = saturate(device, strong));
  EXPECT_NEAR(limited.force.norm(), device.force, 1e-12);
}

TEST(RealTimeHaptics, GuardsNeitherAllocateNorLockOnGoodAndBadInput) {
  InputGuard input({}, kPeriod);
  OutputGuard output({}, *find_device("touch"), kPeriod);
  std::uint32_t faults = 0;
  std::uint32_t status = 0;
  Wrench sent;
  TimedPose pose;
  for (const double x : {0.0, 1e-4, 0.5, std::numeric_limits<double>::quiet_NaN()}) {
    pose.X_JN.translation().x() = x;
    pose.time += kPeriod;
    ARTUS_RUNS_REALTIME(InputGuard::check, faults = input.check(pose));
    const Wrench wanted{Vec3(0, 0, 1e3 * x), Vec3::Zero()};
    ARTUS_RUNS_REALTIME(OutputGuard::apply, sent = output.apply(wanted, faults, status));
    EXPECT_TRUE(sent.force.allFinite());
  }
  EXPECT_EQ(faults, TickStatus::kNotFinite);
}

TEST(RealTimeHaptics, PassivityObserverNeitherAllocatesNorLocks) {
  PassivityObserver observer({.control = true}, kPeriod);
  Vec3 wanted = Vec3::Zero();
  for (const double x : {0.0, 1e-3, 2e-3}) {
    ARTUS_RUNS_REALTIME(PassivityObserver::step,
                        wanted = observer.step(Vec3(x, 0, 0), Vec3::UnitX()));
    ARTUS_RUNS_REALTIME(PassivityObserver::observe, observer.observe(wanted));
  }
  EXPECT_GT(observer.energy_to_hand(), 0) << "the controller's branch was run";
  ARTUS_RUNS_REALTIME(PassivityObserver::pause, observer.pause());
}

}  // namespace
}  // namespace artus
