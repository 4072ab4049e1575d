// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/looking_operator.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kGlance = 0.05;  // s
const std::array<Vec3, 3> kThings{Vec3(25e-3, -20e-3, 0), Vec3(-26e-3, 22e-3, 0),
                                  Vec3(2e-3, 10e-3, 0)};

/// s until all are found by a hand over a plane on which things of 4 mm lie; 1000: never.
double time_of(const OperatorSkill& skill, std::uint64_t seed) {
  LookPlan plan;
  plan.half_x = plan.half_y = 50e-3;
  plan.n = kThings.size();
  LookingOperator hand(skill, plan, seed);
  std::size_t asked = 0;
  double middle_since = -1;
  for (int i = 0; i < 20000; ++i) {
    const double time = kGlance * i;
    LookGlance seen;
    for (const Vec3& thing : kThings) {
      const double x = thing.x() - hand.x();
      const bool in = std::abs(thing.y() - hand.y()) < 4e-3 && std::abs(x) < 0.5 * plan.view;
      seen.x.push_back(in ? std::optional(x) : std::nullopt);
    }
    const bool middle = asked < plan.n && seen.x[asked] && std::abs(*seen.x[asked]) < 4e-3;
    if (!middle) middle_since = -1;
    if (middle && middle_since < 0) middle_since = time;
    if (middle && time - middle_since > 1.8) {
      ++asked;
      middle_since = -1;
    }
    seen.asked = asked;
    const double x = hand.x();
    const double y = hand.y();
    hand.look(time, seen);
    EXPECT_LE(std::hypot(hand.x() - x, hand.y() - y), 40e-3 * kGlance + 1e-12);
    EXPECT_LE(std::max(std::abs(hand.x()), std::abs(hand.y())), plan.half_x + 1e-3);
    if (hand.done()) return time;
  }
  return 1000;
}

TEST(LookingOperator, SweepsItsRectangleFindsAllAndIsDoneThen) {
  for (const std::uint64_t seed : {1U, 2U, 3U})
    EXPECT_LT(time_of(expert_skill(), seed), 60) << seed;
}

TEST(LookingOperator, TheSameSeedDoesTheSameAndAnotherSomethingElse) {
  EXPECT_EQ(time_of(novice_skill(), 5), time_of(novice_skill(), 5));
  EXPECT_NE(time_of(novice_skill(), 5), time_of(novice_skill(), 6));
}

TEST(LookingOperator, WhoDoesNotKnowTheLooksTakesLongerAndLearns) {
  double novice = 0;
  double expert = 0;
  double trained = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    novice += time_of(novice_skill(), seed) / 20;
    trained += time_of(novice_skill(40), seed) / 20;
    expert += time_of(expert_skill(), seed) / 20;
  }
  EXPECT_GT(novice, 1.5 * expert);
  EXPECT_LT(trained, 0.5 * (novice + expert));
}

}  // namespace
}  // namespace artus
