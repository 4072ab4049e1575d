// SPDX-License-Identifier: AGPL-3.0-or-later
// Edges, pieces, rims, cracks and pinches of surfaces small enough to count by hand.
#include "artus/detail/anatomy/surfaces/surface_topology.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/surfaces/defects_cracks.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

SurfaceMesh two_cubes() {
  SurfaceMesh mesh = make_cube(Vec3::Zero(), 0.01);
  append_mesh(mesh, make_cube(Vec3(0.05, 0, 0), 0.005));
  return mesh;
}

TEST(EdgeUses, EachSideOfEachTriangleOnceInOrder) {
  const SurfaceMesh mesh = make_cube(Vec3::Zero(), 1);
  const auto uses = make_edge_uses(mesh);
  EXPECT_EQ(uses.size(), 36U);
  std::size_t edges = 0;
  for_each_edge(uses, [&edges](const EdgeUse* first, const EdgeUse* last) {
    ++edges;
    ASSERT_EQ(last - first, 2);
    EXPECT_NE(first[0].is_forward, first[1].is_forward) << "neighbours run against each other";
  });
  EXPECT_EQ(edges, 18U) << "Euler: 8 - 18 + 12 = 2";
}

TEST(EdgeCounts, OfAClosedAnOpenAndADoubledSurface) {
  SurfaceMesh mesh = make_cube(Vec3::Zero(), 1);
  EXPECT_EQ(count_edges(mesh).open, 0U);
  const Triangle gone = mesh.triangles.back();
  mesh.triangles.pop_back();
  EXPECT_EQ(count_edges(mesh).open, 3U);
  mesh.triangles.push_back(gone);
  mesh.triangles.push_back(gone);
  EXPECT_EQ(count_edges(mesh).non_manifold, 3U);
}

TEST(Pieces, AreNumberedByTheirFirstFaceAndMeasured) {
  const SurfaceMesh mesh = two_cubes();
  const auto uses = make_edge_uses(mesh);
  const Pieces pieces = find_pieces(mesh, uses);
  ASSERT_EQ(pieces.n, 2U);
  EXPECT_EQ(pieces.of_face.front(), 0U);
  EXPECT_EQ(pieces.of_face.back(), 1U);
  const auto measures = measure_pieces(mesh, uses, pieces);
  EXPECT_NEAR(measures[0].area, 24e-4, 1e-12);
  EXPECT_NEAR(measures[1].signed_volume, 1e-6, 1e-15);
  EXPECT_TRUE(measures[0].is_closed);
  EXPECT_TRUE(measures[0].is_consistent);
  EXPECT_FALSE(measures[0].is_pillow());
}

TEST(Pieces, APillowEnclosesNothingAndASheetHasNoInside) {
  SurfaceMesh sheet;
  sheet.vertices = {Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)};
  sheet.triangles = {{0, 1, 2}, {1, 3, 2}};
  auto uses = make_edge_uses(sheet);
  EXPECT_TRUE(measure_pieces(sheet, uses, find_pieces(sheet, uses))[0].is_sheet());
  SurfaceMesh pillow = sheet;
  pillow.triangles.push_back({0, 2, 1});
  pillow.triangles.push_back({1, 2, 3});
  uses = make_edge_uses(pillow);
  EXPECT_TRUE(measure_pieces(pillow, uses, find_pieces(pillow, uses))[0].is_pillow());
}

TEST(Rims, OfATubeAreItsTwoEndsInTheDirectionOfAPatch) {
  const SurfaceMesh tube = make_tube(12, 3, 0.01, 0.04);
  const auto rims = find_rims(tube, make_edge_uses(tube));
  ASSERT_EQ(rims.size(), 2U);
  SurfaceMesh closed = tube;
  for (const auto& rim : rims) {
    EXPECT_EQ(rim.size(), 12U);
    for (std::size_t i = 1; i + 1 < rim.size(); ++i)
      closed.triangles.push_back({rim[0], rim[i], rim[i + 1]});
  }
  EXPECT_EQ(count_edges(closed).open, 0U);
  const double exact = 12 * std::sin(6.283185307179586 / 12) / 2 * 0.01 * 0.01 * 0.04;
  EXPECT_NEAR(std::abs(signed_volume(closed)), exact, 1e-12) << "the patches run the right way";
}

TEST(NestingDepth, CountsHowManyPiecesHoldAPiece) {
  SurfaceMesh mesh = make_cube(Vec3::Zero(), 0.03);
  append_mesh(mesh, make_cube(Vec3::Zero(), 0.02));
  append_mesh(mesh, make_cube(Vec3::Zero(), 0.01));
  append_mesh(mesh, make_cube(Vec3(0.1, 0, 0), 0.01));
  const auto uses = make_edge_uses(mesh);
  EXPECT_EQ(nesting_depth(mesh, find_pieces(mesh, uses)), (std::vector<std::uint32_t>{0, 1, 2, 0}));
}

TEST(KeepFaces, DropsTheVerticesNobodyUses) {
  const SurfaceMesh mesh = two_cubes();
  std::vector<bool> keep(mesh.triangles.size(), false);
  std::fill(keep.begin() + 12, keep.end(), true);
  const SurfaceMesh kept = keep_faces(mesh, keep);
  EXPECT_EQ(kept.vertices.size(), 8U);
  EXPECT_NEAR(signed_volume(kept), 1e-6, 1e-15);
}

TEST(CrackPairs, AreOpenVerticesThatNearlyMeet) {
  // Two squares side by side, 10 um apart, of 10 mm edges.
  SurfaceMesh mesh;
  for (const double x : {0.0, 0.01, 0.01001, 0.02})
    for (const double y : {0.0, 0.01}) mesh.vertices.emplace_back(x, y, 0);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 6, 5}, {5, 6, 7}};
  const auto uses = make_edge_uses(mesh);
  const auto pairs = find_crack_pairs(mesh, uses, 0.1e-3);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].a, 2U);
  EXPECT_EQ(pairs[0].b, 4U);
  EXPECT_NEAR(pairs[0].distance, 1e-5, 1e-12);
  EXPECT_TRUE(find_crack_pairs(mesh, uses, 5e-6).empty());
}

TEST(CrackPairs, TheNarrowEndOfATubeIsNotSewnTogether) {
  const SurfaceMesh tube = make_tube(12, 2, 1e-4, 0.01);  // open edges of 52 um
  EXPECT_TRUE(find_crack_pairs(tube, make_edge_uses(tube), 2e-5).empty());
}

TEST(Pinches, AreVerticesWithTwoFans) {
  SurfaceMesh mesh = make_cube(Vec3::Zero(), 1);
  EXPECT_TRUE(find_pinches(mesh, make_edge_uses(mesh)).empty());
  append_mesh(mesh, make_cube(Vec3::Constant(2), 1));
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t)
      if (v == 8) v = 7;  // the corner where they touch
  EXPECT_EQ(find_pinches(mesh, make_edge_uses(mesh)), (std::vector<std::uint32_t>{7}));
}

}  // namespace
}  // namespace artus
