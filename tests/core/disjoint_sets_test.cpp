// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/disjoint_sets.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

TEST(DisjointSets, ItemsJoinedByAnyChainAreOneSetNamedByItsSmallest) {
  DisjointSets sets(10);
  for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(sets.find(i), i);
  sets.join(9, 7);
  sets.join(3, 5);
  sets.join(5, 9);
  sets.join(9, 5);  // again: nothing changes
  for (const std::uint32_t i : {3U, 5U, 7U, 9U}) EXPECT_EQ(sets.find(i), 3U);
  for (const std::uint32_t i : {0U, 1U, 2U, 4U, 6U, 8U}) EXPECT_EQ(sets.find(i), i);
}

TEST(DisjointSets, TheSameSetsInWhateverOrderTheyAreJoined) {
  // Numbers joined with their doubles: a set for each odd number.
  constexpr std::uint32_t kN = 200;
  DisjointSets up(kN), down(kN);
  for (std::uint32_t i = 1; 2 * i < kN; ++i) up.join(i, 2 * i);
  for (std::uint32_t i = (kN - 1) / 2; i >= 1; --i) down.join(2 * i, i);
  for (std::uint32_t i = 1; i < kN; ++i) {
    std::uint32_t odd = i;
    while (odd % 2 == 0) odd /= 2;
    EXPECT_EQ(up.find(i), odd);
    EXPECT_EQ(down.find(i), odd);
  }
}

}  // namespace
}  // namespace artus
