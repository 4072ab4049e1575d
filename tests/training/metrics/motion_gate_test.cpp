// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/motion_gate.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/training/assessment.h"
#include "tests/session/session_support.h"
#include "tests/support/paths.h"
#include "tests/support/real_time.h"
#include "tests/training/scripted_hands.h"

namespace artus {
namespace {

const Eigen::Quaterniond kLevel{1, 0, 0, 0};

/// Path of a track, m.
double path_of(const PoseSampler& track) {
  double sum = 0;
  const auto points = track.points();
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i].p - points[i - 1].p).norm();
  return sum;
}

TEST(MotionGate, LeavesOutAFlipOfAnyRateAndKeepsTheRest) {
  for (const double rate : {15.0, 60.0, 1000.0}) {
    MotionGate gate;
    PoseSampler track(100);
    int flips = 0;
    for (int i = 0; i < static_cast<int>(4 * rate); ++i) {
      const bool flipped = i % static_cast<int>(rate) == static_cast<int>(rate) / 2;
      flips += flipped ? 1 : 0;
      gate.add(i / rate, Vec3(flipped ? 0.24 : 0, 0, 0.01 * i / rate), kLevel, track);
    }
    EXPECT_EQ(gate.left_out(), static_cast<std::uint64_t>(flips)) << rate;
    EXPECT_NEAR(path_of(track), 0.04, 1e-3) << rate;
  }
}

TEST(MotionGate, TicksThatRepeatATrackersPoseCountOnce) {
  MotionGate gate;
  PoseSampler track(100);
  for (int tick = 0; tick < 4000; ++tick) {
    const int sample = tick / 67;
    const bool flipped = sample == 20 || sample == 21 || sample == 40;
    gate.add(1e-3 * tick, Vec3(flipped ? -0.2 : 0, 0, 0.03 * sample), kLevel, track);  // 0.45 m/s
  }
  EXPECT_EQ(gate.left_out(), 3U);
  EXPECT_NEAR(path_of(track), 0.03 * (3999 / 67), 0.031);
}

TEST(MotionGate, AnAxisThatTurnsRoundIsLeftOutThoughTheTipStays) {
  MotionGate gate;
  EXPECT_TRUE(gate.passes(0, Vec3::Zero(), kLevel));
  EXPECT_FALSE(gate.passes(0.067, Vec3::Zero(), {0, 1, 0, 0}));
  EXPECT_TRUE(gate.passes(0.133, Vec3::Zero(), kLevel));
}

TEST(MotionGate, AFastHandIsNone) {
  MotionGate gate;
  for (int i = 0; i <= 100; ++i) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(0.18 * i, Vec3::UnitX()));  // 18 rad/s
    EXPECT_TRUE(gate.passes(0.01 * i, Vec3(0.018 * i, 0, 0), q)) << i;       // 1.8 m/s
  }
  EXPECT_EQ(gate.left_out(), 0U);
}

TEST(MotionGate, AHandThatIsPutElsewhereIsThereFromThatMoment) {
  MotionGate gate;
  PoseSampler track(100);
  for (int i = 0; i < 3000; ++i)
    gate.add(1e-3 * i, i < 1000 ? Vec3::Zero() : Vec3(0.3, 0, 0), kLevel, track);
  const auto points = track.points();
  EXPECT_NEAR(points[95].p.x(), 0, 1e-9);
  EXPECT_NEAR(points[105].p.x(), 0.3, 1e-9);
  EXPECT_EQ(left_out_notice("needle", 0), "");
}

TEST(MotionGate, AfterAGapAnyPoseMayCome) {
  MotionGate gate;
  EXPECT_TRUE(gate.passes(0, Vec3::Zero(), kLevel));
  EXPECT_TRUE(gate.passes(0.6, Vec3(0.4, 0, 0), kLevel));
}

TEST(MotionGate, TakesAPoseWithoutMemory) {
  MotionGate gate;
  PoseSampler track(10);
  ARTUS_RUNS_REALTIME(MotionGate::add,
                      for (int i = 0; i < 2000; ++i)
                          gate.add(1e-3 * i, Vec3(i % 100 == 50 ? 1 : 0, 0, 0), kLevel, track));
}

TEST(MotionGate, FlipsChangeNoNumberOfAnAttemptAndAreTold) {
  test::ScriptedHands clean;
  test::ScriptedHands flips;
  for (test::ScriptedHands* hands : {&clean, &flips}) {
    for (int i = 0; i < 6; ++i) {
      hands->go(1, 3.0 + 3 * i);
      if (hands == &flips)
        hands->flip(1);
      else
        hands->go(0.01, 3.0 + 3 * i);
    }
    hands->go(2, -5);
  }
  const AttemptMeasures a = clean.measure();
  const AttemptMeasures b = flips.measure();
  EXPECT_EQ(b.needle_left_out, 6U);
  EXPECT_EQ(find_metric(b.metrics, "left_out", "needle")->value, 6);
  EXPECT_EQ(find_metric(b.metrics, "passes")->value, 1);
  EXPECT_NEAR(*find_metric(a.metrics, "path_length_mm", "needle")->value,
              *find_metric(b.metrics, "path_length_mm", "needle")->value, 0.5);
  std::vector<std::string> notices;
  add_left_out(b, notices);
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_EQ(notices[0].rfind("6 poses of the needle were left out", 0), 0U) << notices[0];
}

/// A tracker's own flips, where the cases are at hand.
TEST(MotionGate, ARecordedTrackWithFlipsIsMeasuredLikeTheOneWithout) {
  const auto folder = test::source_dir() / "../shared/cases/03-pose-flips";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const auto scene = test::make_layered_scene();
  const auto assessed = [&](const char* file) {
    const auto list = read_tracked_list(folder / file);
    EXPECT_TRUE(list);
    return assess_list(*list, scene, {});
  };
  const Assessment clean = assessed("pose_clean.csv");
  const Assessment flips = assessed("pose_flip.csv");
  EXPECT_EQ(find_metric(flips.metrics, "passes")->value,
            find_metric(clean.metrics, "passes")->value);
  EXPECT_NEAR(*find_metric(flips.metrics, "path_length_mm", "needle")->value,
              *find_metric(clean.metrics, "path_length_mm", "needle")->value, 0.5);
  ASSERT_FALSE(flips.notices.empty());
  EXPECT_EQ(flips.notices.back().rfind("6 poses of the needle", 0), 0U);
  EXPECT_EQ(clean.notices.size() + 1, flips.notices.size());
}

}  // namespace
}  // namespace artus
