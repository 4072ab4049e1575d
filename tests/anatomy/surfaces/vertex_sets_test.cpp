// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/vertex_sets.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

TEST(VertexSets, AreOfOneEachUntilTheyAreJoined) {
  VertexSets sets(6);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(sets.find_set(i), i);
  sets.union_set(0, 3);
  sets.union_set(3, 5);
  sets.union_set(1, 2);
  EXPECT_EQ(sets.find_set(0), sets.find_set(5));
  EXPECT_EQ(sets.find_set(1), sets.find_set(2));
  EXPECT_NE(sets.find_set(0), sets.find_set(1));
  EXPECT_EQ(sets.find_set(4), 4U);
}

}  // namespace
}  // namespace artus
