// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/insertion_line.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/haptics/needle/insertion_cone.h"

namespace artus {
namespace {

const Vec3 kDown = Vec3::UnitZ();
constexpr double kNeedle = 0.035;  // m

// A line along z from the origin, on which the needle went in to `deep` and came back to `depth`.
InsertionLine withdrawn(double deep, double depth) {
  InsertionLine line({}, kNeedle);
  line.start(Vec3(0, 0, 1e-3), kDown, 1e-3, -kDown);
  for (double x = 1e-3; x < deep; x += 1e-4) line.follow(Vec3(0, 0, x), kDown);
  line.follow(Vec3(0, 0, deep), kDown);
  for (double x = deep; x > depth; x -= 1e-4) line.follow(Vec3(0, 0, x), kDown);
  line.follow(Vec3(0, 0, depth), kDown);
  return line;
}

double off(const InsertionLine& line, const Vec3& tip) {
  return (tip - line.entry() - line.depth(tip) * line.axis()).norm();
}

TEST(InsertionLine, HoldsWhileNothingIsWithdrawn) {
  InsertionLine line = withdrawn(0.02, 0.02);
  const LineChange change = line.follow(Vec3(5e-3, 0, 0.02), kDown);
  EXPECT_EQ(change.turned, 0);
  EXPECT_EQ(change.kept, 1);
  EXPECT_EQ(line.axis(), kDown);
}

TEST(InsertionLine, ATipFarBackDragsItAtTheDistanceThatItBears) {
  const LineParams params;
  InsertionLine line = withdrawn(0.025, 0.015);
  const double bears = params.angle * 0.015;
  const Vec3 near(0.9 * bears, 0, 0.015);
  EXPECT_EQ(line.follow(near, kDown).turned, 0);
  const Vec3 far(2e-3, 0, 0.015);
  const LineChange change = line.follow(far, kDown);
  EXPECT_NEAR(off(line, far), bears, 1e-5);
  EXPECT_NEAR(change.turned, 2e-3 - bears, 2e-5);
  EXPECT_NEAR(change.kept, std::exp(-change.turned / params.drag), 1e-12);
  EXPECT_LT(line.entry().norm(), 1e-15) << "it turns about its entry";
}

// With an edge, the line would be held or lost by the last hundredth of a millimetre.
TEST(InsertionLine, MovesContinuouslyWithHowFarTheNeedleWasWithdrawnAndIsAside) {
  double before = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double back = 1e-5 * i;
    InsertionLine line = withdrawn(0.02, 0.02 - back);
    const Vec3 tip(1e-3, 0, 0.02 - back);
    line.follow(tip, kDown);
    const double angle = std::atan2(line.axis().x(), line.axis().z());
    EXPECT_NEAR(angle, before, 8e-4) << "withdrawn " << back;
    before = angle;
  }
  EXPECT_GT(before, 0.06) << "all the way the line went along";
}

// The same path in steps of another size ends on the same line.
TEST(InsertionLine, DependsOnThePathNotOnItsSteps) {
  const auto run = [](int steps) {
    InsertionLine line({}, kNeedle);
    line.start(Vec3(0, 0, 1e-3), kDown, 1e-3, -kDown);
    line.follow(Vec3(0, 0, 0.025), kDown);
    double kept = 1;
    for (int i = 0; i <= steps; ++i) {  // out by 13 mm and in by 10 while it sways
      const double s = static_cast<double>(i) / steps;
      const double x = s < 0.5 ? 0.025 - 0.026 * s : 0.012 + 0.02 * (s - 0.5);
      kept *= line.follow(Vec3(1e-3 * std::sin(40 * s), 0, x), kDown).kept;
    }
    return std::pair(line.axis(), kept);
  };
  const auto fine = run(40000);
  const auto coarse = run(1300);
  EXPECT_LT((fine.first - coarse.first).norm(), 1e-4);
  EXPECT_NEAR(fine.second, coarse.second, 2e-4);
}

// A needle that went in by a hair more or less comes out on the same line.
TEST(InsertionLine, IsLetGoContinuouslyWithHowDeepTheNeedleWasNearTheSkin) {
  const Vec3 own = Vec3(0.1, 0, 1).normalized();
  double before = 0;
  for (int i = 0; i <= 400; ++i) {
    const double deep = 1e-3 + 1e-5 * i;
    InsertionLine line = withdrawn(deep, deep);
    for (double z = deep; z > 0.9e-3; z -= 1e-5) line.follow(Vec3(0.3e-3, 0, z), own);
    const double angle = std::atan2(line.axis().x(), line.axis().z());
    EXPECT_TRUE(i == 0 || std::abs(angle - before) < 2e-3) << "in to " << deep;
    before = angle;
  }
  EXPECT_GT(before, 0.05);
}

TEST(InsertionLine, HoldsATipAsideByNoMoreThanItIsDeep) {
  for (const double depth : {1e-6, 1e-4, 5e-4}) {
    InsertionLine line({}, kNeedle);
    line.start(Vec3::Zero(), kDown, 0, -kDown);
    line.follow(Vec3(0, 0, depth), kDown);
    const Vec3 aside(2e-3, 0, depth);
    const Vec3 own = Vec3(0.5, 0, 1).normalized();
    double kept = 1;
    for (int i = 1; i <= 2000; ++i) {
      const double share = i / 2000.0;
      kept *= line.follow(share * aside + (1 - share) * Vec3(0, 0, depth),
                          (share * own + (1 - share) * kDown).normalized())
                  .kept;
    }
    const double in = line.depth(aside);
    EXPECT_LT(in, 2 * depth + 1e-5);
    EXPECT_LE(off(line, aside), in + 1e-6);
    const double turned = std::acos(std::min(1.0, own.dot(line.axis())));
    EXPECT_LE(turned, 1.5708 * in / 3e-3 + 1e-3);
    EXPECT_LT(kept, 0.1) << "its old track is not the tip's any more";
    EXPECT_NEAR(line.entry().z(), 0, 1e-12);
  }
}

TEST(InsertionLine, StaysInsideTheCone) {
  InsertionLine line = withdrawn(0.03, 0.01);
  for (int i = 1; i <= 300; ++i) line.follow(Vec3(5e-5 * i, 0, 0.01), kDown);
  const double angle = std::atan2(line.axis().x(), line.axis().z());
  EXPECT_LE(angle, insertion_cone(0.01, kNeedle)) << "the tip itself is at 56 degrees";
  EXPECT_GT(angle, 0.4);
}

TEST(InsertionLine, OnTheWayOutOfTheSkinItBecomesTheNeedlesOwnAxis) {
  InsertionLine line = withdrawn(0.02, 3.1e-3);
  const Vec3 own = Vec3(0.1, 0, 1).normalized();
  Vec3 tip;
  double kept = 1;
  for (double z = 3e-3; z > 1e-6; z -= 1e-6) {
    tip = Vec3(0.4e-3, 0, z);
    kept *= line.follow(tip, own).kept;
  }
  EXPECT_LT(off(line, tip), 5e-6);
  EXPECT_LT((line.axis() - own).norm(), 1e-3);
  EXPECT_LT(kept, 1e-3) << "nothing of the old track is left";
  EXPECT_NEAR(line.entry().z(), 0, 1e-12) << "the entry slides along the skin";
}

}  // namespace
}  // namespace artus
