// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/thumb.h"

#include <gtest/gtest.h>

#include "tests/support/real_time.h"

namespace artus {
namespace {

constexpr double kArea = 1.14e-4;  // m^2
constexpr double kDt = 1e-3;       // s

TEST(Thumb, RestsWithoutAPhaseAndGivesAForceWhereThatIsMeant) {
  Thumb thumb;
  const PlungerState still;
  EXPECT_EQ(thumb.step(nullptr, still, kArea, kDt).force, 0);
  OperatorPhase pull = stay(1);
  pull.thumb_force = -6;
  const PlungerInput input = thumb.step(&pull, still, kArea, kDt);
  EXPECT_EQ(input.force, -6);
  EXPECT_EQ(input.stiffness, 0);
}

TEST(Thumb, HoldsAPlungerAgainstWhatPushesItBack) {
  Thumb thumb;
  OperatorPhase hold = stay(1);
  hold.thumb_holds = true;
  PlungerState tense;
  tense.pressure = 25e3;
  EXPECT_DOUBLE_EQ(thumb.step(&hold, tense, kArea, kDt).force, 25e3 * kArea);
  tense.pressure = 25e6;
  EXPECT_EQ(thumb.step(&hold, tense, kArea, kDt).force, ThumbParams{}.max_force);
  tense.pressure = -25e3;
  EXPECT_EQ(thumb.step(&hold, tense, kArea, kDt).force, 0);
}

TEST(Thumb, RunsAheadAtItsRateUpToItsStrongestPush) {
  Thumb thumb;
  PlungerState held;
  held.travel = 2e-3;
  OperatorPhase push = stay(60);
  push.thumb_rate = 1e-7;
  PlungerInput input;
  for (int k = 0; k < 1000; ++k) input = thumb.step(&push, held, kArea, kDt);
  EXPECT_NEAR(input.position - held.travel, 1e-7 / kArea, 1e-9);
  for (int k = 0; k < 60000; ++k) input = thumb.step(&push, held, kArea, kDt);
  EXPECT_NEAR(input.stiffness * (input.position - held.travel), ThumbParams{}.max_force, 1e-9);
  ARTUS_RUNS_REALTIME(Thumb::step, test::use(thumb.step(&push, held, kArea, kDt)));
}

}  // namespace
}  // namespace artus
