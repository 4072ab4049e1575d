// SPDX-License-Identifier: AGPL-3.0-or-later
// What a face presses with at most.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/soft/pressed_block.h"

namespace artus {
namespace {

using test::face_at;
using test::Pressed;

SoftSolverParams at_most(double force) {
  SoftSolverParams params;
  params.most_force = force;
  return params;
}

TEST(FaceLimit, FaceThatWouldPressTooHardStaysOffTheHandAndComesBackToIt) {
  constexpr double kMost = 0.6;  // N
  Pressed pressed(0, at_most(kMost));
  SoftSolver& solver = *pressed.solver;
  const auto force = [&] {
    return -solver.last().contact.force.z();
  };
  for (const double deep : {6e-3, 12e-3}) {
    ASSERT_TRUE(solver.settle(face_at(deep))) << deep;
    EXPECT_NEAR(force(), kMost, 0.03 * kMost) << deep;
    EXPECT_NE(solver.last().status & kSoftHeldOff, 0U);
    EXPECT_GT(solver.held_off(), 1e-3);
    EXPECT_NEAR((solver.face_pose().translation() - Vec3(0, 0, deep - solver.held_off())).norm(), 0,
                1e-9);
  }
  ASSERT_TRUE(solver.settle(face_at(1e-3)));
  EXPECT_EQ(solver.held_off(), 0);
  EXPECT_EQ(solver.last().status & kSoftHeldOff, 0U);
  Pressed other;
  ASSERT_TRUE(other.solver->settle(face_at(1e-3)));
  EXPECT_NEAR(force(), -other.solver->last().contact.force.z(), 1e-3 * force());
}

TEST(FaceLimit, HandThatFallsIntoTheBodyPressesItNoHarder) {
  constexpr double kMost = 0.6;  // N
  Pressed pressed(0, at_most(kMost));
  SoftSolver& solver = *pressed.solver;
  for (int k = 0; k < 120; ++k) {
    if (k % 12 == 0) solver.begin_refresh();
    if (k % 12 == 8) solver.end_refresh();
    solver.step(face_at(std::min(12e-3, 2e-3 * k)), 1.0 / 80);
    ASSERT_EQ(solver.last().status & kSoftRestarted, 0U) << k;
  }
  EXPECT_NEAR(-solver.last().contact.force.z(), kMost, 0.03 * kMost);
}

}  // namespace
}  // namespace artus
