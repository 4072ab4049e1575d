// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/raycast/indexed_surfaces.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace artus {
namespace {

/// A strip of triangles along x, the last one of a region that is not meshed.
struct Strip {
  std::vector<Vec3> vertices;
  std::vector<Interface> interfaces;

  explicit Strip(std::uint32_t n = 6) {
    for (std::uint32_t i = 0; i < n + 2; ++i)
      vertices.emplace_back(0.01 * i, i % 2 == 0 ? 0.0 : 0.02, 0.1);
    for (std::uint32_t i = 0; i < n; ++i)
      interfaces.push_back({{i, i + 1, i + 2}, i + 1 == n ? kBeyond : RegionId{5}, RegionId{4}});
  }
};

TEST(IndexedSurfaces, StandAroundTheirMiddleWithTheirPlanes) {
  Strip strip;
  strip.vertices.emplace_back(9, 9, 9);  // of tetrahedra alone
  const IndexedSurfaces surfaces(strip.vertices, strip.interfaces);
  EXPECT_EQ(surfaces.vertices.size(), 8U);
  EXPECT_LT((surfaces.centre - Vec3(0.035, 0.01, 0.1)).norm(), 1e-15);
  EXPECT_NEAR(surfaces.radius, std::hypot(0.035, 0.01), 1e-15);
  ASSERT_EQ(surfaces.facets.size(), strip.interfaces.size());
  for (std::size_t i = 0; i < surfaces.facets.size(); ++i) {
    const FacetPlane& plane = surfaces.facets[i].plane;
    EXPECT_NEAR(plane.normal.z(), i % 2 == 0 ? -1 : 1, 1e-15) << i;
    for (const std::uint32_t v : surfaces.triangles[i])
      EXPECT_NEAR(plane.normal.dot(surfaces.vertices[v]), plane.offset, 1e-15) << i;
  }
  EXPECT_FALSE(surfaces.can_move());
  EXPECT_EQ(surfaces.all.members, (IndexedSurfaces::Members{{0, 1, 2, 3, 4, 5}}));
  EXPECT_EQ(surfaces.boundary.members, (IndexedSurfaces::Members{{5}}));
  EXPECT_EQ(surfaces.boundary.corners[0], (std::vector<IndexedSurfaces::Corners>{{5, 6, 7}}));
}

/// Groups 0 and 1, and vertices that are never moved: each triangle is in one block; a group moves
/// the blocks that have a vertex of it, and none else.
TEST(IndexedSurfaces, HaveABlockForEachGroupAndForWhatIsBetween) {
  const Strip strip(9);
  constexpr std::array<std::uint32_t, 4> kFirst{3, 1, 0, 2};
  constexpr std::array<std::uint32_t, 4> kSecond{4, 5, 6, 7};
  const std::array<IndexedSurfaces::Group, 2> groups{kFirst, kSecond};
  const std::array<std::uint32_t, 8> of{0, 0, 0, 0, 1, 1, 1, 1};
  const IndexedSurfaces surfaces(strip.vertices, strip.interfaces, groups);
  ASSERT_TRUE(surfaces.can_move());
  EXPECT_EQ(surfaces.begins, (std::vector<std::uint32_t>{0, 4, 8}));
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(surfaces.vertices[k], Vec3(strip.vertices[kFirst[k]] - surfaces.centre)) << k;
  for (std::size_t i = 0; i < 9; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(surfaces.vertices[surfaces.triangles[i][k]],
                Vec3(strip.vertices[strip.interfaces[i].vertices[k]] - surfaces.centre))
          << i;
  }
  std::vector<std::uint32_t> seen;
  for (std::size_t block = 0; block < surfaces.n_blocks; ++block) {
    for (const std::uint32_t i : surfaces.all.members[block]) {
      EXPECT_EQ(surfaces.block_of[i], block);
      seen.push_back(i);
    }
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  for (std::uint32_t group = 0; group < 2; ++group) {
    std::set<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < 9; ++i) {
      for (const std::uint32_t v : strip.interfaces[i].vertices) {
        if (v < of.size() && of[v] == group) expected.insert(surfaces.block_of[i]);
      }
    }
    const auto& at = surfaces.blocks_at[group];
    EXPECT_EQ(std::set<std::uint32_t>(at.begin(), at.end()), expected) << group;
  }
  EXPECT_NE(surfaces.block_of[0], surfaces.block_of[2]);  // all of a group; between two of them
  EXPECT_NE(surfaces.block_of[2], surfaces.block_of[4]);
  EXPECT_EQ(surfaces.boundary.members[surfaces.block_of[8]], std::vector<std::uint32_t>{8});
}

TEST(IndexedSurfaces, RefuseWhatIsNoInterface) {
  Strip one_region;
  one_region.interfaces[2].back = one_region.interfaces[2].front;
  Strip out_of_range;
  out_of_range.interfaces[1].vertices[0] = 99;
  Strip not_finite;
  not_finite.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  for (const Strip& strip : {one_region, out_of_range, not_finite})
    EXPECT_THROW(IndexedSurfaces(strip.vertices, strip.interfaces), std::invalid_argument);
}

TEST(IndexedSurfaces, RefuseAVertexOfTwoGroupsOrOfNoInterface) {
  const Strip strip;
  constexpr std::array<std::uint32_t, 2> kOne{1, 2};
  for (const std::array<std::uint32_t, 2>& other :
       {std::array<std::uint32_t, 2>{2, 3}, {4, 4}, {7, 8}}) {
    const std::array<IndexedSurfaces::Group, 2> groups{kOne, other};
    EXPECT_THROW(IndexedSurfaces(strip.vertices, strip.interfaces, groups), std::invalid_argument);
  }
}

TEST(IndexedSurfaces, MayBeNone) {
  const IndexedSurfaces none({}, {});
  EXPECT_EQ(none.radius, 0);
  EXPECT_TRUE(none.facets.empty());
}

}  // namespace
}  // namespace artus
