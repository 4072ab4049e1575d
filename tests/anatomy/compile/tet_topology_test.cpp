// SPDX-License-Identifier: AGPL-3.0-or-later
// Neighbours, parts and interfaces on a cube of tetrahedra, where all of them can be counted.
#include "artus/detail/anatomy/compile/mesh/tet_topology.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "tests/anatomy/compile/tet_samples.h"

namespace artus {
namespace {

constexpr double kSide = 0.04;  // m
constexpr std::uint32_t kCells = 4;

RegionId all_one(const Vec3&) {
  return kFirstRegion;
}

RegionId halves(const Vec3& p) {
  return p.x() < kSide / 2 ? kFirstRegion : kFirstRegion + 1;
}

TEST(TetFace, IsSeenCounterClockwiseFromOutside) {
  const TetMesh mesh = test::make_cube_of_tets(1, kSide, all_one);
  for (const auto& tet : mesh.tetrahedra) {
    for (int k = 0; k < 4; ++k) {
      const auto f = tet_face(tet, k);
      const Vec3& a = mesh.vertices[f[0]];
      const Vec3 normal = (mesh.vertices[f[1]] - a).cross(mesh.vertices[f[2]] - a);
      EXPECT_LT(normal.dot(mesh.vertices[tet[static_cast<std::size_t>(k)]] - a), 0);
    }
  }
}

TEST(TetNeighbours, AreMutualAndMissingOnTheHullAlone) {
  const TetMesh mesh = test::make_cube_of_tets(kCells, kSide, all_one);
  const auto neighbours = find_tet_neighbours(mesh);
  ASSERT_TRUE(neighbours);
  std::size_t hull = 0;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (const std::uint32_t n : (*neighbours)[t]) {
      if (n == kNoTet) {
        ++hull;
      } else {
        const auto& back = (*neighbours)[n];
        EXPECT_EQ(std::count(back.begin(), back.end(), t), 1);
      }
    }
  }
  EXPECT_EQ(hull, 6U * 2 * kCells * kCells) << "two triangles for each square of six sides";
}

TEST(TetNeighbours, AFaceOfThreeTetrahedraIsRefused) {
  TetMesh mesh = test::make_cube_of_tets(1, kSide, all_one);
  mesh.tetrahedra.push_back(mesh.tetrahedra.front());
  mesh.tetrahedra.push_back(mesh.tetrahedra.front());
  const auto neighbours = find_tet_neighbours(mesh);
  ASSERT_FALSE(neighbours);
  EXPECT_EQ(neighbours.error().code, ErrorCode::failed);
}

TEST(TetParts, HaveTheVolumesOfWhatIsConnected) {
  // One region in two slabs, another between them.
  const TetMesh mesh = test::make_cube_of_tets(kCells, kSide, [](const Vec3& p) -> RegionId {
    return p.z() < kSide / 4 || p.z() > kSide / 2 ? kFirstRegion : kFirstRegion + 1;
  });
  const TetParts parts = find_tet_parts(mesh, *find_tet_neighbours(mesh));
  ASSERT_EQ(parts.volume.size(), 3U);
  const double slab = kSide * kSide * kSide / 4;
  std::multiset<int> quarters;
  for (std::size_t i = 0; i < 3; ++i)
    quarters.insert(static_cast<int>(std::lround(parts.volume[i] / slab)));
  EXPECT_EQ(quarters, (std::multiset<int>{1, 1, 2}));
  for (std::size_t t = 0; t < mesh.regions.size(); ++t)
    EXPECT_EQ(parts.region[parts.part[t]], mesh.regions[t]);
}

TEST(AbsorbCrumbs, GivesASmallPartToTheNeighbourItSharesMostWithButNeverALargestOne) {
  // A crumb of one cell of region 4 inside region 2, and region 4's proper part at the far end.
  const double cell = kSide / kCells;
  TetMesh mesh = test::make_cube_of_tets(kCells, kSide, [cell](const Vec3& p) -> RegionId {
    if (p.x() > 3 * cell) return kFirstRegion + 2;
    return (p - Vec3::Constant(1.5 * cell)).cwiseAbs().maxCoeff() < cell / 2 ? kFirstRegion + 2
                                                                             : kFirstRegion;
  });
  const auto neighbours = find_tet_neighbours(mesh);
  TetMesh untouched = mesh;
  EXPECT_EQ(merge_fragments(untouched, *neighbours, [](RegionId) { return 0.0; }), 0U);
  EXPECT_EQ(untouched.regions, mesh.regions);
  EXPECT_EQ(merge_fragments(mesh, *neighbours, [](RegionId) { return 1.0; }), 1U)
      << "the parts that are the largest of their region stay, however small";
  const auto volumes = region_volumes(mesh, kFirstRegion + 3);
  const double whole = kSide * kSide * kSide;
  EXPECT_NEAR(volumes[kFirstRegion], 0.75 * whole, 1e-12 * whole);
  EXPECT_NEAR(volumes[kFirstRegion + 2], 0.25 * whole, 1e-12 * whole);
}

TEST(RebuildInterfaces, MakesTheFacesBetweenRegionsAndTheHullAndPointsThemFromBackToFront) {
  const TetMesh mesh = test::make_body_of_tets(kCells, kSide, halves);
  EXPECT_EQ(mesh.interfaces.size(), 7U * 2 * kCells * kCells) << "six sides and the middle";
  std::map<std::pair<RegionId, RegionId>, Vec3> area;
  for (const Interface& f : mesh.interfaces) {
    const Vec3& a = mesh.vertices[f.vertices[0]];
    const Vec3 vector =
        (mesh.vertices[f.vertices[1]] - a).cross(mesh.vertices[f.vertices[2]] - a) / 2;
    area.try_emplace({f.back, f.front}, Vec3::Zero()).first->second += vector;
  }
  const double face = kSide * kSide;
  // A closed surface has no net area: the hull of one half lacks the middle, towards +x or -x.
  const Vec3 left = area.at({kFirstRegion, kOutside});
  const Vec3 right = area.at({kFirstRegion + 1, kOutside});
  EXPECT_NEAR((left + face * Vec3::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR((right - face * Vec3::UnitX()).norm(), 0, 1e-12);
  Vec3 middle = Vec3::Zero();
  if (area.count({kFirstRegion, kFirstRegion + 1}) > 0)
    middle += area.at({kFirstRegion, kFirstRegion + 1});
  if (area.count({kFirstRegion + 1, kFirstRegion}) > 0)
    middle -= area.at({kFirstRegion + 1, kFirstRegion});
  EXPECT_NEAR((middle - face * Vec3::UnitX()).norm(), 0, 1e-12);
}

TEST(RebuildInterfaces, AsksForTheFrontOfTheHull) {
  TetMesh mesh = test::make_cube_of_tets(2, kSide, all_one);
  rebuild_interfaces(mesh, *find_tet_neighbours(mesh),
                     [](const Vec3& p) { return p.z() == 0 ? kBeyond : kOutside; });
  const auto beyond = std::count_if(mesh.interfaces.begin(), mesh.interfaces.end(),
                                    [](const Interface& f) { return f.front == kBeyond; });
  EXPECT_EQ(beyond, 2 * 2 * 2);
}

TEST(OrderVertices, PutsThoseOnInterfacesFirstDropsUnusedOnesAndMovesNothing) {
  TetMesh mesh = test::make_body_of_tets(kCells, kSide, halves);
  mesh.vertices.insert(mesh.vertices.begin(), Vec3::Constant(99));  // used by nobody
  for (auto& t : mesh.tetrahedra)
    for (auto& v : t) ++v;
  for (auto& f : mesh.interfaces)
    for (auto& v : f.vertices) ++v;
  const TetMesh before = mesh;
  order_vertices(mesh);
  ASSERT_EQ(mesh.vertices.size(), before.vertices.size() - 1);
  std::set<std::uint32_t> on_interfaces;
  for (const Interface& f : mesh.interfaces)
    on_interfaces.insert(f.vertices.begin(), f.vertices.end());
  EXPECT_EQ(*on_interfaces.rbegin() + 1, on_interfaces.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k)
      ASSERT_EQ(mesh.vertices[mesh.tetrahedra[t][k]], before.vertices[before.tetrahedra[t][k]]);
}

TEST(RegionVolumes, AddUpToTheWhole) {
  const TetMesh mesh = test::make_cube_of_tets(kCells, kSide, halves);
  const auto volumes = region_volumes(mesh, kFirstRegion + 2);
  const double half = kSide * kSide * kSide / 2;
  EXPECT_NEAR(volumes[kFirstRegion], half, 1e-12 * half);
  EXPECT_NEAR(volumes[kFirstRegion + 1], half, 1e-12 * half);
  EXPECT_EQ(volumes[kOutside], 0);
}

}  // namespace
}  // namespace artus
