// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/solids/surfacing.h"

#include <numbers>

#include <gtest/gtest.h>

#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/simple_shoulder.h"
#include "artus/detail/meshes/generate/solids/sweep.h"
#include "tests/meshes/topology.h"

namespace artus {
namespace {

Solid ball_of_20_mm() {
  return {"ball", make_ball(Vec3(0.01, 0, 0), 20e-3), Vec3(0.01, 0, 0), 0.1, 2e-3, 0.05e-3};
}

void expect_sound(const SurfaceMesh& mesh) {
  const Topology topology = compute_topology(mesh);
  EXPECT_TRUE(topology.manifold);
  EXPECT_TRUE(topology.closed);
  EXPECT_TRUE(topology.outward);
  EXPECT_FALSE(topology.self_intersecting);
}

TEST(ComputeSurface, BallHasTheVolumeOfABall) {
  const auto mesh = compute_surface(ball_of_20_mm());
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  const double exact = 4.0 / 3.0 * std::numbers::pi * 20e-3 * 20e-3 * 20e-3;
  EXPECT_NEAR(signed_volume(*mesh), exact, 0.01 * exact);
  expect_sound(*mesh);
}

TEST(ComputeSurface, TriangleCornersLieOnTheSolid) {
  const Solid solid = ball_of_20_mm();
  const auto mesh = compute_surface(solid);
  ASSERT_TRUE(mesh);
  for (const Vec3& v : mesh->vertices) EXPECT_NEAR(solid.field(v), 0, 1e-6);
}

TEST(ComputeSurface, SameSolidGivesTheSameBytes) {
  const auto first = compute_surface(ball_of_20_mm());
  const auto second = compute_surface(ball_of_20_mm());
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(first->triangles == second->triangles);
  EXPECT_TRUE(first->vertices == second->vertices);
}

TEST(ComputeSurface, BentThinTubeIsFoundWhole) {
  const Solid solid{"nerve",
                    make_tube({{Vec3(0, 0, 0), 1e-3},
                               {Vec3(0.02, 0.01, 0), 1e-3},
                               {Vec3(0.03, 0.03, 0.01), 1e-3},
                               {Vec3(0.02, 0.05, 0), 1e-3}}),
                    Vec3(0.02, 0.01, 0),
                    0.2,
                    0.8e-3,
                    0.05e-3};
  const auto mesh = compute_surface(solid);
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  expect_sound(*mesh);
  double farthest = 0;
  for (const Vec3& v : mesh->vertices) farthest = std::max(farthest, v.y());
  EXPECT_NEAR(farthest, 0.051, 5e-4);
}

TEST(ComputeSurface, SeedOutsideTheSolidIsRefused) {
  Solid solid = ball_of_20_mm();
  solid.seed = Vec3(0.05, 0, 0);
  const auto mesh = compute_surface(solid);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, ErrorCode::failed);
  EXPECT_EQ(mesh.error().where, "ball");
}

TEST(MakeShoulder, EverySeedLiesInItsSolid) {
  for (const Solid& s : make_shoulder({})) EXPECT_LT(s.field(s.seed), 0) << s.name;
  for (const Solid& s : make_simple_shoulder({})) EXPECT_LT(s.field(s.seed), 0) << s.name;
}

TEST(MakeShoulder, AnotherHeadRadiusScalesTheHeadAndKeepsTheBursasThickness) {
  ShoulderSize small;
  small.head_radius = 20e-3;
  const std::vector<Solid> bones = make_shoulder_bones(small);
  EXPECT_EQ(bones.front().name, "humerus");
  const Vec3 medial = Vec3(0.78, 0.30, 0.55).normalized();
  EXPECT_NEAR(bones.front().field(20e-3 * medial), 0, 1e-9);
  for (const Solid& s : make_shoulder_soft_tissue(small)) {
    if (s.name != "subacromial_bursa") continue;
    EXPECT_NEAR(s.field(s.seed), -0.5 * small.bursa, 0.1e-3);
  }
}

TEST(MakeShoulder, SizesMustBePositive) {
  ShoulderSize size;
  size.fat = 0;
  EXPECT_THROW(static_cast<void>(make_shoulder(size)), std::invalid_argument);
}

}  // namespace
}  // namespace artus
