// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/syringe_course.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "artus/detail/training/metrics/attempt_meter.h"
#include "tests/session/session_support.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

/// A syringe told at 1 kHz.
class Syringe : public ::testing::Test {
 protected:
  /// `ml_s` for `seconds`, with the tip at depth `z` (m) of region `region`.
  void run(double seconds, double ml_s, double z = 0, RegionId region = kFirstRegion) {
    for (int i = 0; i < static_cast<int>(1000 * seconds + 0.5); ++i) {
      now_.time += 1e-3;
      now_.flow = 1e-6 * ml_s;
      now_.given += 1e-9 * ml_s;
      now_.thumb = 10 * ml_s;
      now_.pressure = 50e3 * ml_s;
      now_.region = region;
      now_.tip = Vec3(0, 0, z);
      course_.add(now_);
    }
  }
  SyringeTick now_;
  SyringeCourse course_;
};

TEST_F(Syringe, TellsFlowVolumePeaksAndPauses) {
  run(1, 0);
  run(4, 0.2);
  run(3, 0);
  run(2, 0.5);
  run(1, 0);  // a pause of 1 s is none
  run(1, 0.5);
  const SyringeTotals& sum = course_.totals();
  EXPECT_TRUE(sum.used);
  EXPECT_NEAR(sum.given, 2.3e-6, 1e-15);
  EXPECT_NEAR(sum.flowing, 7, 1e-9);
  EXPECT_NEAR(sum.busy, 7, 1e-9);
  EXPECT_NEAR(sum.peak_flow, 0.5e-6, 1e-18);
  EXPECT_NEAR(sum.peak_thumb, 5, 1e-12);
  EXPECT_NEAR(sum.peak_pressure, 25e3, 1e-9);
  EXPECT_EQ(sum.pauses, 1);
  EXPECT_NEAR(sum.test_dose, 0.8e-6, 1e-15);
  EXPECT_EQ(sum.aspirations, 0);
}

TEST_F(Syringe, AnAspirationLastsTwoSeconds) {
  run(1, 0);
  run(1.9, -0.2);  // as -10 kPa
  run(1, 0);
  EXPECT_EQ(course_.totals().aspirations, 0);
  run(5, -0.2);
  EXPECT_EQ(course_.totals().aspirations, 1);
  EXPECT_TRUE(course_.totals().aspirated_first);
  run(1, 0.5);
  EXPECT_NEAR(course_.totals().given, 0.5e-6, 1e-15) << "what was drawn back counts as given";
}

TEST_F(Syringe, ATipThatMovesWhileItFlowsDrifts) {
  run(1, 0, 1e-3);
  run(1, 0.2, 5e-3);
  run(1, 0.2, 7e-3);
  run(1, 0, 20e-3);
  EXPECT_NEAR(course_.totals().tip_drift, 2e-3, 1e-15);
}

TEST_F(Syringe, DosesAddUpToWhatWasGivenByPlaceEvenWhenMemoryEnds) {
  course_ = SyringeCourse(5);
  run(1, 0);
  run(1, 0.02, 1e-3, kFirstRegion);
  run(1, 0.1, 2e-3, kFirstRegion + 1);
  double all = 0;
  double first = 0;
  for (const Dose& dose : course_.doses()) {
    all += dose.volume;
    if (dose.region == kFirstRegion) first += dose.volume;
  }
  EXPECT_EQ(course_.doses().size(), 5U);
  EXPECT_NEAR(all, 0.12e-6, 1e-15);
  EXPECT_NEAR(first, 0.02e-6, 1e-15);
}

TEST_F(Syringe, TakesATickWithoutMemory) {
  ARTUS_RUNS_REALTIME(SyringeCourse::add, course_.add({}));
}

TEST(SyringeMetrics, SayHowFarFromTheTargetAndHowMuchInWhichLayer) {
  MeterOptions options;
  options.goals.target = Target{"a point", Vec3(0, 0, 10e-3), nullptr};
  AttemptMeter meter(test::make_layered_scene(), options);
  SyringeTick tick;
  meter.add_syringe(tick);
  const auto give = [&](double ml, double z, RegionId region) {
    tick.time += 1;
    tick.flow = 1e-6 * ml;
    tick.given += 1e-6 * ml;
    tick.region = region;
    tick.tip = Vec3(0, 0, z);
    meter.add_syringe(tick);
  };
  give(3, 12e-3, kFirstRegion + 2);
  give(1, 6e-3, kFirstRegion + 1);
  const auto metrics = meter.measure().metrics;
  EXPECT_NEAR(*find_metric(metrics, "given_distance_mm")->value, (3 * 2 + 1 * 4) / 4.0, 1e-9);
  EXPECT_NEAR(*find_metric(metrics, "given_ml:muscle")->value, 3, 1e-12);
  EXPECT_NEAR(*find_metric(metrics, "given_ml:fat")->value, 1, 1e-12);
  EXPECT_FALSE(find_metric(metrics, "in_target")->value) << "a point holds nothing";
  EXPECT_FALSE(find_metric(metrics, "test_dose_ml")->value);
  const AttemptMeter unused(test::make_layered_scene(), {});
  EXPECT_FALSE(find_metric(unused.measure().metrics, "given_ml")->value);
}

}  // namespace
}  // namespace artus
