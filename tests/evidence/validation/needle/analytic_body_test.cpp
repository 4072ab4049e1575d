// SPDX-License-Identifier: AGPL-3.0-or-later
// Stretches of a line through half spaces and balls, against the closed form.
#include "artus/detail/evidence/validation/needle/analytic_body.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/real_time.h"

namespace artus {
namespace {

std::vector<TissueInterval> intervals_of(const AnalyticBody& body, const Segment& segment) {
  std::vector<TissueInterval> found(8);
  const QueryCount count = body.find_intervals(segment, found);
  EXPECT_FALSE(count.truncated);
  found.resize(count.size);
  return found;
}

TEST(AnalyticBody, AStackIsCutWhereItsPlanesAre) {
  const AnalyticBody body = AnalyticBody::make_stack(Vec3(0, 0, 1), Vec3::UnitZ(), {0, 0.01, 0.03});
  const Vec3 direction = Vec3(1, 0, 1).normalized();
  const Segment segment{Vec3(0, 0, 0.99), Vec3(0, 0, 0.99) + 0.1 * direction};
  const auto found = intervals_of(body, segment);
  ASSERT_EQ(found.size(), 4U);
  const double slope = std::sqrt(0.5);
  const std::array<double, 5> expected{0, 0.01 / slope, 0.02 / slope, 0.04 / slope, 0.1};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(found[i].entry, expected[i], 1e-15);
    EXPECT_NEAR(found[i].exit, expected[i + 1], 1e-15);
    EXPECT_EQ(found[i].region, i == 0 ? kOutside : kFirstRegion + i - 1);
  }
  EXPECT_EQ(found[1].entry_normal, -Vec3::UnitZ());
}

TEST(AnalyticBody, BallsAreEnteredAndLeftInTurn) {
  const AnalyticBody body = AnalyticBody::make_balls(Vec3::Zero(), {0.05, 0.03});
  const auto found = intervals_of(body, {Vec3(-0.1, 0, 0.018), Vec3(0.1, 0, 0.018)});
  ASSERT_EQ(found.size(), 5U);
  const double inner = std::sqrt(0.03 * 0.03 - 0.018 * 0.018);
  EXPECT_NEAR(found[2].exit - found[2].entry, 2 * inner, 1e-15);
  EXPECT_EQ(found[2].region, kFirstRegion + 1);
  EXPECT_EQ(found[4].region, kOutside);
}

TEST(AnalyticBody, SaysWhenThereIsNoRoomForAll) {
  const AnalyticBody body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, 0.01, 0.02});
  std::array<TissueInterval, 2> buffer;
  const QueryCount count = body.find_intervals({Vec3(0, 0, -0.01), Vec3(0, 0, 0.03)}, buffer);
  EXPECT_TRUE(count.truncated);
  EXPECT_EQ(count.size, 2U);
}

TEST(AnalyticBody, NeitherAllocatesNorLocks) {
  const AnalyticBody body = AnalyticBody::make_balls(Vec3::Zero(), {0.05, 0.03});
  std::array<TissueInterval, 8> buffer;
  const Segment segment{Vec3(-0.1, 0, 0), Vec3(0.1, 0, 0)};
  std::size_t n = 0;
  ARTUS_RUNS_REALTIME(AnalyticBody::find_intervals, n = body.find_intervals(segment, buffer).size);
  EXPECT_EQ(n, 5U);
}

}  // namespace
}  // namespace artus
