// SPDX-License-Identifier: AGPL-3.0-or-later
// Where the needle was placed, for courses whose answer is known in closed form.
#include "artus/detail/training/metrics/placement.h"

#include <cmath>

#include <gtest/gtest.h>

namespace artus {
namespace {

/// A needle that goes straight down, at 20 Hz.
class Needle {
 public:
  /// To `depth` mm at `speed` mm/s.
  Needle& go(double depth, double speed) {
    const double from = depth_;
    const int n = std::max(1, static_cast<int>(std::lround(20 * std::abs(depth - from) / speed)));
    for (int i = 1; i <= n; ++i) put(from + (depth - from) * i / n);
    return *this;
  }
  Needle& rest(double seconds, double tremor = 0) {
    const double at = depth_;
    for (int i = 0; i < static_cast<int>(20 * seconds); ++i) put(at + tremor * std::sin(2.3 * i));
    depth_ = at;
    return *this;
  }
  std::vector<CoursePoint> course;

 private:
  void put(double depth) {
    depth_ = depth;
    CoursePoint p;
    p.time = 0.05 * static_cast<double>(course.size());
    p.depth = 1e-3 * std::max(0.0, depth);
    p.tip = Vec3(0, 0, 1e-3 * depth);
    p.region = depth > 0 ? kFirstRegion : kOutside;
    course.push_back(p);
  }
  double depth_ = -5;
};

Target at_depth(double mm) {
  return {"the point", Vec3(0, 0, 1e-3 * mm), nullptr};
}

double placed(const Needle& needle, double target, std::span<const Dose> doses = {}) {
  const Target goal = at_depth(target);
  const auto at = find_placement(needle.course, &goal, doses);
  return at ? 1e3 * needle.course[*at].tip.z() : std::nan("");
}

TEST(Placement, IsTheRestOnTargetWhateverPausesTheWithdrawalHas) {
  for (const double pause : {0.6, 1.0, 3.0, 4.5})
    for (const double where : {3.0, 7.2, 12.0}) {
      Needle needle;
      needle.go(20, 8).rest(30).go(where, 10).rest(pause).go(-5, 10);
      EXPECT_NEAR(placed(needle, 20), 20, 1e-9) << pause << " s at " << where;
      const auto free = find_placement(needle.course);
      ASSERT_TRUE(free);
      EXPECT_NEAR(1e3 * needle.course[*free].tip.z(), 20, 1e-9);
    }
}

TEST(Placement, IsTheRestOnTargetHoweverSlowTheWithdrawal) {
  for (const double speed : {0.2, 0.4, 1.0, 1.9, 5.0}) {
    Needle needle;
    needle.go(20, 8).rest(30).go(-5, speed);
    EXPECT_NEAR(placed(needle, 20), 20, 0.2) << speed;
  }
}

TEST(Placement, OfWhoDoesNotStopIsTheDeepestPoint) {
  for (const double speed : {1.5, 4.0, 20.0}) {
    Needle needle;
    needle.go(26, speed).go(-5, speed);
    EXPECT_NEAR(placed(needle, 20), 26, 0.1) << speed;
  }
}

TEST(Placement, OfWhoPausesOnlyOnTheWayOutIsTheDeepestPoint) {
  Needle needle;
  needle.go(32, 8).go(20, 8).rest(3).go(-5, 8);
  EXPECT_NEAR(placed(needle, 20), 32, 0.5);
}

TEST(Placement, ACorrectionCountsWhenTheNeedleStaysThere) {
  Needle little;
  little.go(23, 8).rest(1).go(20, 4).rest(10).go(-5, 8);
  EXPECT_NEAR(placed(little, 20), 20, 1e-9);
  Needle far;
  far.go(32, 8).rest(1).go(20, 4).rest(10).go(-5, 8);
  EXPECT_NEAR(placed(far, 20), 20, 1e-9);
  Needle again;  // out by 12 mm, forward again: not the way out
  again.go(32, 8).rest(1).go(15, 8).go(20, 4).rest(1).go(-5, 8);
  EXPECT_NEAR(placed(again, 20), 20, 1e-9);
}

TEST(Placement, AnAdvanceThatPassesTheTargetSlowlyIsNoStay) {
  Needle needle;
  needle.go(30, 1).rest(30).go(-5, 8);
  EXPECT_NEAR(placed(needle, 20), 30, 1e-9);
}

TEST(Placement, TremorIsRest) {
  Needle needle;
  needle.go(20, 8).rest(5, 0.15).go(8, 8).rest(3).go(-5, 8);
  EXPECT_NEAR(placed(needle, 20), 20, 0.2);
}

TEST(Placement, IsWhereHalfOfTheLiquidHadBeenGiven) {
  Needle needle;
  needle.go(20, 8).rest(10).go(26, 8).rest(10).go(-5, 8);
  const double there = needle.course[needle.course.size() / 2].time;
  std::vector<Dose> doses;
  for (int i = 0; i < 100; ++i)
    doses.push_back({1e-8, kFirstRegion, Vec3::Zero(), 14 + 0.04 * i});  // ml by ml at 26 mm
  ASSERT_GT(there, 10);
  EXPECT_NEAR(placed(needle, 20, doses), 26, 1e-9);
  doses.resize(5);  // a drop is no injection
  EXPECT_NEAR(placed(needle, 20, doses), 20, 1e-9);
}

TEST(Placement, ThereIsNoneOutside) {
  Needle needle;
  needle.go(-1, 5).rest(5);
  EXPECT_FALSE(find_placement(needle.course));
  EXPECT_FALSE(find_placement({}));
}

}  // namespace
}  // namespace artus
