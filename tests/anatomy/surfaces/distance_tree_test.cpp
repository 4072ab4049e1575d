// SPDX-License-Identifier: AGPL-3.0-or-later
// Distance and winding number against closed forms and against every triangle one by one.
#include "artus/detail/anatomy/surfaces/distance_tree.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

constexpr double kFar = 10;  // m

Vec3 random_point(std::uint64_t i, double half) {
  return half * (2 * Vec3(uniform_noise(9, 3 * i), uniform_noise(9, 3 * i + 1),
                          uniform_noise(9, 3 * i + 2)) -
                 Vec3::Ones());
}

TEST(DistanceTree, DistanceToACubeIsExact) {
  const DistanceTree tree(make_cube(Vec3(1, 2, 3), 0.5));
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Vec3 p = random_point(i, 1.5);
    const Vec3 q = p.cwiseAbs() - Vec3::Constant(0.5);
    const double exact = std::abs(q.cwiseMax(Vec3::Zero()).norm() + std::min(q.maxCoeff(), 0.0));
    ASSERT_NEAR(tree.distance(p + Vec3(1, 2, 3), kFar), exact, 1e-12);
  }
}

TEST(DistanceTree, DistanceToManyTrianglesIsTheLeastOfAll) {
  const SurfaceMesh mesh = make_sphere(Vec3::Zero(), 0.02);
  const DistanceTree tree(mesh);
  for (std::uint64_t i = 0; i < 30; ++i) {
    const Vec3 p = random_point(i, 0.04);
    double least = kFar;
    for (const Triangle& t : mesh.triangles) {
      SurfaceMesh one;
      one.vertices = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
      one.triangles = {{0, 1, 2}};
      least = std::min(least, DistanceTree(one).distance(p, kFar));
    }
    EXPECT_NEAR(tree.distance(p, kFar), least, 1e-15);
  }
}

TEST(DistanceTree, ABoundIsGivenBackWhereNothingIsNearer) {
  const DistanceTree tree(make_cube(Vec3::Zero(), 0.5));
  EXPECT_EQ(tree.distance(Vec3(2, 0, 0), 1), 1);
  EXPECT_NEAR(tree.distance(Vec3(2, 0, 0), 1.6), 1.5, 1e-15);
}

TEST(DistanceTree, WindingNumberIsOneInsideAndZeroOutside) {
  const DistanceTree tree(make_sphere(Vec3::Zero(), 0.02));
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Vec3 p = random_point(i, 0.04);
    if (std::abs(p.norm() - 0.02) < 2e-4) continue;
    EXPECT_NEAR(tree.winding_number(p), p.norm() < 0.02 ? 1 : 0, 0.05)
        << "far dipoles, first order";
  }
}

TEST(DistanceTree, OfAnOpenHemisphereItIsAHalfAtTheCentre) {
  SurfaceMesh half = make_sphere(Vec3::Zero(), 0.02);
  std::erase_if(half.triangles,
                [&](const Triangle& t) { return triangle_centre(half, t).z() < 0; });
  EXPECT_NEAR(DistanceTree(half).winding_number(Vec3::Zero()), 0.5, 0.01);
}

TEST(DistanceTree, OverlappingPiecesAddUpAndATurnedOneTakesAway) {
  SurfaceMesh mesh = make_cube(Vec3::Zero(), 0.5);
  append_mesh(mesh, make_cube(Vec3(0.4, 0, 0), 0.5));
  EXPECT_NEAR(DistanceTree(mesh).winding_number(Vec3(0.2, 0.1, 0)), 2, 1e-9);
  SurfaceMesh hollow = make_cube(Vec3::Zero(), 0.5);
  SurfaceMesh hole = make_cube(Vec3::Zero(), 0.2);
  for (Triangle& t : hole.triangles) std::swap(t[0], t[1]);
  append_mesh(hollow, hole);
  EXPECT_NEAR(DistanceTree(hollow).winding_number(Vec3(0.01, 0.02, 0.03)), 0, 1e-9);
}

TEST(DistanceTree, OfNothingIsEverywhereFar) {
  const DistanceTree tree{SurfaceMesh{}};
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.distance(Vec3::Zero(), kFar), kFar);
  EXPECT_EQ(tree.winding_number(Vec3::Zero()), 0);
}

TEST(DistanceTree, KnowsItsBox) {
  const DistanceTree tree(make_cube(Vec3(1, 2, 3), 0.5));
  EXPECT_EQ(tree.lower(), Vec3(0.5, 1.5, 2.5));
  EXPECT_EQ(tree.upper(), Vec3(1.5, 2.5, 3.5));
}

}  // namespace
}  // namespace artus
