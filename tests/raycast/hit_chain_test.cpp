// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/raycast/hit_chain.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/raycast/facet.h"

namespace artus {
namespace {

/// What the probe finds, from the regions of unit stretches of the line.
struct Truth {
  std::vector<RegionId> regions;
  static RegionId at(const void* state, double depth) noexcept {
    const auto& self = *static_cast<const Truth*>(state);
    return self.regions.at(static_cast<std::size_t>(depth));
  }
};

std::vector<Hit> repaired(const std::vector<Hit>& hits, const Truth& truth = {},
                          bool doubtful = false) {
  const auto chain = std::make_unique<HitChain>();
  repair_chain(hits, {0, 6, doubtful}, {Truth::at, &truth}, *chain);
  return {chain->hits.begin(), chain->hits.begin() + static_cast<std::ptrdiff_t>(chain->size)};
}

TEST(Facet, IsOneCacheLine) {
  EXPECT_EQ(sizeof(Facet), 64U);
  EXPECT_EQ(alignof(Facet), 64U);
}

TEST(IsChain, AcceptsContiguousRegionsAndRefusesBreaksAndTouches) {
  EXPECT_TRUE(is_chain({}));
  EXPECT_TRUE(is_chain(std::vector<Hit>{{1, 0, 0, 2}, {2, 1, 2, 3}}));
  EXPECT_FALSE(is_chain(std::vector<Hit>{{1, 0, 0, 2}, {2, 1, 3, 2}}));
  EXPECT_FALSE(is_chain(std::vector<Hit>{{1, 0, 0, 2}, {1, 1, 2, 0}}));
}

TEST(SortHits, OrdersByDepthThenInterfaceForFewAndMany) {
  for (const std::size_t count : {std::size_t{5}, std::size_t{200}}) {
    std::vector<Hit> hits;
    for (std::size_t i = 0; i < count; ++i) {
      hits.push_back(
          {static_cast<double>((i * 7919) % 13), static_cast<std::uint32_t>(count - i), 0, 2});
    }
    sort_hits(hits);
    for (std::size_t i = 1; i < count; ++i) {
      EXPECT_TRUE(hits[i - 1].depth < hits[i].depth || (hits[i - 1].depth == hits[i].depth &&
                                                        hits[i - 1].interface < hits[i].interface));
    }
  }
}

TEST(RepairChain, ASharedEdgeCountsOnce) {
  const auto chain = repaired({{1, 7, 0, 2}, {1, 8, 0, 2}, {3, 9, 2, 0}});
  ASSERT_EQ(chain.size(), 2U);
  EXPECT_EQ(chain[0].interface, 7U);
  EXPECT_EQ(chain[1].interface, 9U);
}

TEST(RepairChain, ATouchThatLeadsBackIsNoCrossing) {
  EXPECT_TRUE(repaired({{1.5, 7, 0, 2}, {1.5, 8, 2, 0}}, {{0, 0, 0, 0, 0, 0}}).empty());
}

TEST(RepairChain, HitsOfOnePlaceFindTheirOrder) {
  // Skin then fat at one depth, listed the wrong way round.
  const auto chain = repaired({{1, 1, 2, 3}, {1, 2, 0, 2}, {3, 3, 3, 0}}, {{0, 3, 3, 0}});
  ASSERT_EQ(chain.size(), 3U);
  EXPECT_EQ(chain[0].interface, 2U);
  EXPECT_EQ(chain[1].interface, 1U);
  EXPECT_LE(chain[0].depth, chain[1].depth);
}

TEST(RepairChain, AMissedHitIsBridgedByWhatIsReallyThere) {
  // 0 -> 2 at 1, the hit 2 -> 3 lost, 3 -> 0 at 5.5.
  const auto chain = repaired({{1, 1, 0, 2}, {5.5, 2, 3, 0}}, {{0, 2, 3, 3, 3, 3, 0}});
  ASSERT_EQ(chain.size(), 2U);
  EXPECT_EQ(chain[0].to, chain[1].from);
  EXPECT_EQ(chain[0].to, 3);
}

TEST(RepairChain, HalfATouchAtAnEdgeIsNoCrossing) {
  EXPECT_TRUE(repaired({{1.5, 8, 2, 0}}, {{0, 0, 0, 0, 0, 0, 0}}, true).empty());
}

TEST(RepairChain, LeavingAsBeyondAndReturningAsOutsideHasASeamInTheMiddle) {
  const auto chain = repaired({{1, 1, 2, kBeyond}, {3, 2, kOutside, 2}});
  ASSERT_EQ(chain.size(), 3U);
  EXPECT_EQ(chain[1].interface, kNoInterface);
  EXPECT_EQ(chain[1].depth, 2);
  EXPECT_EQ(chain[1].from, kBeyond);
  EXPECT_EQ(chain[1].to, kOutside);
}

}  // namespace
}  // namespace artus
