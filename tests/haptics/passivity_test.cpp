// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/passivity.h"

#include <cmath>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kStep = 1e-3;

// A source of energy: pushes with 0.1 N the way the tip goes, at 10 mm/s to and fro.
double run_source(const PassivityParams& params, int ticks) {
  PassivityObserver observer(params, kStep);
  double x = 0;
  double distance = 1;
  for (int i = 0; i < ticks; ++i) {
    if (i % 200 == 199) distance = -distance;
    x += distance * 1e-5;
    observer.observe(observer.step(Vec3(x, 0, 0), Vec3(0.1 * distance, 0, 0)));
  }
  return observer.energy_to_hand();
}

TEST(PassivityObserver, CountsForceTimesWayExactly) {
  PassivityObserver observer({}, kStep);
  observer.observe(observer.step(Vec3(0, 0, 0), Vec3(2, 0, 0)));
  observer.observe(observer.step(Vec3(1e-3, 5e-3, 0), Vec3(0, -3, 0)));  // 2 N over 1 mm
  EXPECT_NEAR(observer.energy_to_hand(), 2e-3, 1e-15);
  observer.observe(observer.step(Vec3(1e-3, 7e-3, 0), Vec3::Zero()));  // -3 N over 2 mm
  EXPECT_NEAR(observer.energy_to_hand(), -4e-3, 1e-15);
}

TEST(PassivityObserver, ASpringGivesBackWhatItTook) {
  PassivityObserver observer({}, kStep);
  const int n = 1000;
  double most = 0;
  for (int i = 0; i <= 2 * n; ++i) {
    const double x = 5e-3 * (i <= n ? i : 2 * n - i) / n;
    observer.observe(observer.step(Vec3(0, 0, x), Vec3(0, 0, -1000 * x)));
    most = std::max(most, -observer.energy_to_hand());
  }
  EXPECT_NEAR(most, 0.5 * 1000 * 25e-6, 2e-5);
  // Sampled: K step^2 a tick too much over the whole way back.
  EXPECT_NEAR(observer.energy_to_hand(), 1000 * 5e-3 * 5e-3 / n, 1e-6);
}

TEST(PassivityObserver, AGapIsNotCounted) {
  PassivityObserver observer({}, kStep);
  observer.observe(observer.step(Vec3(0, 0, 0), Vec3(1, 0, 0)));
  observer.pause();
  observer.observe(observer.step(Vec3(1, 0, 0), Vec3::Zero()));
  EXPECT_EQ(observer.energy_to_hand(), 0);
}

TEST(PassivityController, TakesBackWhatASourceGives) {
  // 3999 ways of which the 20 turns meet the force before them.
  EXPECT_NEAR(run_source({}, 4000), (3999 - 2 * 20) * 1e-6, 1e-9) << "without control it adds up";
  PassivityParams control;
  control.control = true;
  EXPECT_LT(run_source(control, 4000), 3e-6) << "with it, no more than a tick's worth stays";
}

TEST(PassivityController, LeavesAPassiveForceAlone) {
  PassivityParams control;
  control.control = true;
  PassivityObserver observer(control, kStep);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wanted(0, 0, -2);
    const Vec3 sent = observer.step(Vec3(0, 0, 1e-5 * i), wanted);
    EXPECT_EQ(sent, wanted);
    observer.observe(sent);
  }
}

}  // namespace
}  // namespace artus
